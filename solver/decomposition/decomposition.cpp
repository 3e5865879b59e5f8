#include "solver/decomposition/decomposition.hpp"

#include "solver/decomposition/methods.hpp"
#include "solver/error.hpp"
#include "solver/nearest_name.hpp"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <tuple>

namespace dss {
namespace {

constexpr std::array<std::string_view, 3> methods = {"strips", "blocks", "metis"};

std::vector<std::string> method_names() { return {methods.begin(), methods.end()}; }

/// The given weights, or 1 for each if none are given.
std::vector<double> resolved(const std::vector<double>& weights, std::size_t count,
                             const char* what, const char* owner) {
  if (weights.empty()) return std::vector<double>(count, 1.0);
  if (weights.size() != count)
    throw InputError(fmt::format("{} {} for {} {}; give one for each, or none", weights.size(),
                                 what, count, owner));
  for (std::size_t k = 0; k < count; ++k)
    if (!(weights[k] > 0) || !std::isfinite(weights[k]))
      throw InputError(fmt::format(
          "{}: {} is not a positive number; give 1 to all that count the same", what, weights[k]));
  return weights;
}

void require_divisible(const Problem& problem, std::string_view method, int parts) {
  const auto refuse_more_than = [&](std::size_t most, const char* what) {
    if (std::size_t(parts) > most)
      throw InputError(
          fmt::format("scene {} has {} {} for {} parts of method {}; take at most {} parts",
                      problem.name, most, what, parts, method, most));
  };
  if (parts < 1)
    throw InputError(fmt::format("parts: {} is not a number of parts; take 1 or more", parts));
  refuse_more_than(problem.lattice.element_count, "elements");
  if (method == "strips") refuse_more_than(problem.lattice.rows.size(), "rows");
}

[[noreturn]] void fail(const Segment& segment, const std::string& what) {
  throw InputError(
      fmt::format("segment [{}, {}, {}]: {}", segment.row, segment.x_begin, segment.x_end, what));
}

void require_inside(const Share& share, const Decomposition& decomposition,
                    const Lattice& lattice) {
  const Segment& s = share.segment;
  if (share.part < 0 || share.part >= decomposition.parts)
    fail(s, fmt::format("there is no part {}; parts are 0 .. {}", share.part,
                        decomposition.parts - 1));
  if (s.row < 0 || std::size_t(s.row) >= lattice.rows.size())
    fail(s, fmt::format("there is no row {}; rows are 0 .. {}", s.row, lattice.rows.size() - 1));
  const Row& row = lattice.rows[std::size_t(s.row)];
  if (s.x_begin < row.x_begin || s.x_end > row.x_end || s.x_begin >= s.x_end)
    fail(s, fmt::format("is not a range of cells of row {}, which has x = {} .. {}", s.row,
                        row.x_begin, row.x_end - 1));
}

void require_holes(const Lattice& lattice, const CellGrid& grid, int row, int x_begin, int x_end) {
  if (x_begin >= x_end) return;
  const Row& here = lattice.rows[std::size_t(row)];
  const int limit = grid.has_holes(row) ? x_end : x_begin + 1;
  for (int x = x_begin; x < limit; ++x)
    if (lattice.is_present(here, x))
      throw InputError(
          fmt::format("row {}: the element at x = {} belongs to no part; give it to one", row, x));
}

} // namespace

std::span<const std::string_view> decomposition_methods() { return methods; }

std::string why_no_decomposition(std::string_view method) {
  if (std::find(methods.begin(), methods.end(), method) == methods.end())
    return fmt::format("unknown; {}", nearest_name(std::string(method), method_names()));
  return method == "metis" ? why_no_metis() : "";
}

void sort_shares(std::vector<Share>& shares) {
  std::sort(shares.begin(), shares.end(), [](const Share& a, const Share& b) {
    return std::tie(a.segment.row, a.segment.x_begin) < std::tie(b.segment.row, b.segment.x_begin);
  });
}

std::vector<Share> tidy(const std::vector<Share>& shares, const Lattice& lattice) {
  std::vector<Share> result;
  for (Share share : shares) {
    Segment& s = share.segment;
    const Row& row = lattice.rows[std::size_t(s.row)];
    while (s.x_begin < s.x_end && !lattice.is_present(row, s.x_begin)) ++s.x_begin;
    while (s.x_begin < s.x_end && !lattice.is_present(row, s.x_end - 1)) --s.x_end;
    if (s.x_begin == s.x_end) continue;
    if (!result.empty() && result.back().part == share.part && result.back().segment.row == s.row)
      result.back().segment.x_end = s.x_end;
    else
      result.push_back(share);
  }
  return result;
}

Decomposition decompose(const Problem& problem, std::string_view method, int parts,
                        const Weights& weights) {
  if (const std::string why = why_no_decomposition(method); !why.empty())
    throw InputError(fmt::format("method {}: {}", method, why));
  require_divisible(problem, method, parts);
  const CellGrid grid(problem);
  const Division division{problem, grid,
                          resolved(weights.speed, std::size_t(parts), "speeds", "parts"),
                          resolved(weights.body_cost, problem.bodies.size(), "costs", "bodies")};
  std::vector<Share> shares = method == "strips"   ? divide_in_strips(division)
                              : method == "blocks" ? divide_in_blocks(division)
                                                   : divide_by_metis(division);
  sort_shares(shares);
  Decomposition decomposition{std::string(method), parts, tidy(shares, problem.lattice)};
  require_fit(decomposition, problem.lattice);
  return decomposition;
}

std::vector<std::size_t> part_elements(const Decomposition& decomposition, const Lattice& lattice) {
  const CellGrid grid(lattice);
  std::vector<std::size_t> elements(std::size_t(std::max(decomposition.parts, 0)), 0);
  for (const Share& share : decomposition.shares)
    elements[std::size_t(share.part)] += grid.element_count(share.segment);
  return elements;
}

void require_fit(const Decomposition& decomposition, const Lattice& lattice) {
  const CellGrid grid(lattice);
  int row = 0, x = lattice.rows.at(0).x_begin; // elements before this cell are covered
  const auto skip_to = [&](int next_row) {
    while (row < next_row) {
      require_holes(lattice, grid, row, x, grid.row(row).x_end);
      if (std::size_t(++row) < lattice.rows.size()) x = grid.row(row).x_begin;
    }
  };
  for (const Share& share : decomposition.shares) {
    const Segment& s = share.segment;
    require_inside(share, decomposition, lattice);
    if (std::tie(s.row, s.x_begin) < std::tie(row, x))
      fail(s, fmt::format("of part {} overlaps a segment before it, or is not in ascending order",
                          share.part));
    skip_to(s.row);
    require_holes(lattice, grid, row, x, s.x_begin);
    x = s.x_end;
  }
  skip_to(int(lattice.rows.size()));
  const std::vector<std::size_t> elements = part_elements(decomposition, lattice);
  for (std::size_t part = 0; part < elements.size(); ++part)
    if (elements[part] == 0)
      throw InputError(
          fmt::format("part {} has no element; give it some, or take fewer than {} parts", part,
                      decomposition.parts));
}

} // namespace dss
