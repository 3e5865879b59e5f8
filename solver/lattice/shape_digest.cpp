#include "solver/lattice/shape_digest.hpp"

#include "solver/digest.hpp"

namespace dss {

std::string shape_digest(const Lattice& lattice) {
  std::string text(lattice.present.begin(), lattice.present.end());
  // Without its end, a row could take cells of the next one.
  for (const Row& row : lattice.rows)
    text += fmt::format("{} {} {} {} {},", row.body, row.x_begin, row.x_end, row.y, row.z);
  return text_digest(text);
}

} // namespace dss
