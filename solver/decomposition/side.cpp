#include "solver/decomposition/part.hpp"

#include <algorithm>

namespace dss {
namespace {

/// Row of the part's lattice with this element.
int row_of_element(const Part& part, std::size_t element) {
  const auto& rows = part.problem.lattice.rows;
  const auto after =
      std::upper_bound(rows.begin(), rows.end(), element,
                       [](std::size_t e, const Row& row) { return e < row.first_element; });
  return int(after - rows.begin()) - 1;
}

} // namespace

Side side_of(const Part& part, const Neighbour& neighbour) {
  if (part.runs.empty() || neighbour.receive.empty()) return Side::among;
  const Run& last_run = part.runs.back();
  const int first = row_of_element(part, part.runs.front().local);
  const int last = row_of_element(part, last_run.local + last_run.count - 1);
  if (row_of_element(part, neighbour.receive.back()) < first) return Side::lower;
  if (row_of_element(part, neighbour.receive.front()) > last) return Side::upper;
  return Side::among;
}

} // namespace dss
