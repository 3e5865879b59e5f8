#include "solver/model/ensemble.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace dss {
namespace {

std::string where_links_differ(const Problem& one, const Problem& other) {
  if (one.extra_links.size() != other.extra_links.size())
    return fmt::format("{} extra links, not {}", other.extra_links.size(), one.extra_links.size());
  for (std::size_t n = 0; n < one.extra_links.size(); ++n) {
    const ExtraLink &a = one.extra_links[n], &b = other.extra_links[n];
    if (a.i != b.i || a.j != b.j || a.axis != b.axis)
      return fmt::format("extra link {} joins other elements", n);
    if (a.law != b.law) return fmt::format("extra link {} has another law", n);
  }
  return {};
}

} // namespace

Ensemble interleave(std::vector<const Problem*> members, std::vector<double> dt) {
  Ensemble ensemble{std::move(members), std::move(dt), {}};
  const Lattice& one = ensemble.members.front()->lattice;
  const int width = int(ensemble.size());
  Lattice& all = ensemble.lattice;
  all.rows = one.rows;
  for (Row& row : all.rows) {
    row.x_begin *= width;
    row.x_end *= width;
    row.first_element *= ensemble.size();
    row.first_cell *= ensemble.size();
  }
  all.present.reserve(one.present.size() * ensemble.size());
  for (const std::uint8_t is_present : one.present)
    all.present.insert(all.present.end(), ensemble.size(), is_present);
  all.element_count = one.element_count * ensemble.size();
  all.x_stride = width;
  return ensemble;
}

std::string why_other_topology(const Problem& one, const Problem& other) {
  if (one.bodies.size() != other.bodies.size())
    return fmt::format("{} bodies, not {}", other.bodies.size(), one.bodies.size());
  for (std::size_t b = 0; b < one.bodies.size(); ++b)
    if (one.bodies[b].law != other.bodies[b].law)
      return fmt::format("body \"{}\" has another law", other.bodies[b].name);
  if (one.lattice.element_count != other.lattice.element_count)
    return fmt::format("{} elements, not {}", other.lattice.element_count,
                       one.lattice.element_count);
  const auto is_same = [](const Row& a, const Row& b) {
    return a.body == b.body && a.y == b.y && a.z == b.z && a.x_begin == b.x_begin &&
           a.x_end == b.x_end;
  };
  if (!std::ranges::equal(one.lattice.rows, other.lattice.rows, is_same) ||
      one.lattice.present != other.lattice.present)
    return "its elements lie elsewhere";
  if (one.has_rotating_frame() != other.has_rotating_frame())
    return other.has_rotating_frame() ? "its frame rotates" : "its frame does not rotate";
  if (one.materials != other.materials) return "its elements are of other materials";
  if (one.has_mass_ratios() != other.has_mass_ratios())
    return "the densities of its materials are equal in one of them";
  if (one.link_kinds != other.link_kinds) return "links of its bodies are of other kinds";
  if (one.pressure_kinds != other.pressure_kinds)
    return "elements of its bodies have other pressures, because nu is 0 in one of them";
  return where_links_differ(one, other);
}

} // namespace dss
