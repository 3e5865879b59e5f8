/// Counts links between parts from the ends of segments, without visiting the links inside.
#include "solver/decomposition/cell_set.hpp"
#include "solver/decomposition/part.hpp"

#include <tuple>

namespace dss {
namespace {

using Shares = std::span<const Share>;

/// Links along x, between the end of a segment and the begin of another part's segment.
std::size_t cut_in_row(const CellGrid& grid, Shares shares) {
  std::size_t count = 0;
  for (std::size_t k = 1; k < shares.size(); ++k) {
    const Row& row = grid.row(shares[k].segment.row);
    const int x = shares[k].segment.x_begin;
    count += shares[k - 1].part != shares[k].part && grid.lattice().is_present(row, x - 1) &&
             grid.lattice().is_present(row, x);
  }
  return count;
}

/// Links between two neighbouring rows, where segments of different parts face each other.
std::size_t cut_between(const CellGrid& grid, Shares lower, Shares upper) {
  std::size_t count = 0;
  auto a = lower.begin(), b = upper.begin();
  while (a != lower.end() && b != upper.end()) {
    const int begin = std::max(a->segment.x_begin, b->segment.x_begin);
    const int end = std::min(a->segment.x_end, b->segment.x_end);
    if (a->part != b->part && begin < end) {
      const int r = a->segment.row, s = b->segment.row;
      if (!grid.has_holes(r) && !grid.has_holes(s)) {
        count += std::size_t(end - begin);
      } else {
        for (int x = begin; x < end; ++x)
          count += grid.lattice().is_present(grid.row(r), x) &&
                   grid.lattice().is_present(grid.row(s), x);
      }
    }
    a->segment.x_end < b->segment.x_end ? ++a : ++b;
  }
  return count;
}

int owner_of(const Decomposition& decomposition, const Cell& cell) {
  const auto found = std::upper_bound(decomposition.shares.begin(), decomposition.shares.end(),
                                      cell, [](const Cell& c, const Share& share) {
                                        return std::tie(c.row, c.x) <
                                               std::tie(share.segment.row, share.segment.x_end);
                                      });
  return found->part;
}

} // namespace

std::size_t cut_links(const Problem& problem, const Decomposition& decomposition) {
  const CellGrid grid(problem.lattice);
  const std::size_t rows = problem.lattice.rows.size();
  std::vector<std::size_t> first(rows + 1, 0); // index of each row's first share
  for (const Share& share : decomposition.shares) ++first[std::size_t(share.segment.row) + 1];
  for (std::size_t r = 0; r < rows; ++r) first[r + 1] += first[r];
  const auto of_row = [&](std::size_t r) {
    return Shares(decomposition.shares).subspan(first[r], first[r + 1] - first[r]);
  };
  std::size_t count = 0;
  for (std::size_t r = 0; r < rows; ++r) {
    count += cut_in_row(grid, of_row(r));
    for (const int upper : {problem.lattice.rows[r].upper_y, problem.lattice.rows[r].upper_z})
      if (upper >= 0) count += cut_between(grid, of_row(r), of_row(std::size_t(upper)));
  }
  for (const ExtraLink& link : problem.extra_links)
    count += owner_of(decomposition, grid.cell_of(link.i)) !=
             owner_of(decomposition, grid.cell_of(link.j));
  return count;
}

} // namespace dss
