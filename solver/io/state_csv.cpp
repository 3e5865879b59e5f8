#include "solver/io/state_csv.hpp"

#include <fmt/format.h>
#include <iterator>

namespace dss {

void write_state_csv(AtomicFile& file, const Problem& problem, std::span<const double> state,
                     std::span<const ElementStress> stress) {
  constexpr int columns[] = {ux, uy, uz, qs, qx, qy, qz, vx, vy, vz, wx, wy, wz};
  file.write("element,x,y,z,ux,uy,uz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz,stress_vm\n");
  fmt::memory_buffer line;
  problem.lattice.for_each_element([&](std::size_t element, const Row& row, int x) {
    const Vec3 centre = rest_position(problem, row, x);
    const double* fields = &state[element * field_count];
    line.clear();
    fmt::format_to(std::back_inserter(line), "{},{:.17g},{:.17g},{:.17g}", element, centre[0],
                   centre[1], centre[2]);
    for (const int column : columns)
      fmt::format_to(std::back_inserter(line), ",{:.17g}",
                     column == qs ? 1 + fields[qs] : fields[column]);
    fmt::format_to(std::back_inserter(line), ",{:.17g}\n", von_mises(stress[element].stress));
    file.write({line.data(), line.size()});
  });
}

} // namespace dss
