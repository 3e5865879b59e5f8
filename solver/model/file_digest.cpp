#include "solver/model/file_digest.hpp"

#include "solver/digest.hpp"
#include "solver/lattice/shape_digest.hpp"

#include <bit>
#include <fmt/format.h>

namespace dss {

std::string file_digest(const Problem& problem) {
  Digest digest;
  for (const Body& body : problem.bodies)
    for (const Vec3* place : {&body.edge, &body.origin})
      for (const double number : *place) digest.add(std::bit_cast<std::uint64_t>(number));
  for (const std::uint8_t material : problem.materials) digest.add(material);
  for (const Load& load : problem.loads)
    for (const std::size_t element : load.elements) digest.add(element);
  for (const Clamp& clamp : problem.clamps) digest.add(clamp.element);
  for (const ExtraLink& link : problem.extra_links) digest.add(link.i), digest.add(link.j);
  return text_digest(shape_digest(problem.lattice) + series_digest(problem) +
                     fmt::format("{:016x}", digest.value()));
}

} // namespace dss
