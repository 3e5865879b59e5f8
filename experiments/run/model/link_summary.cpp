#include "experiments/run/model/link_summary.hpp"

#include "experiments/base/text_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

namespace dss {

std::vector<LinkSummary> summarize_links(const Problem& problem) {
  std::vector<int> body_of(problem.lattice.element_count);
  problem.lattice.for_each_element(
      [&](std::size_t e, const Row& row, int) { body_of[e] = row.body; });
  std::map<std::tuple<int, int, std::size_t>, std::size_t> counts;
  problem.lattice.for_each_link([&](std::size_t i, std::size_t, int axis) {
    ++counts[{body_of[i], axis, problem.link_kind(i, axis)}];
  });
  std::vector<LinkSummary> links;
  for (const auto& [key, count] : counts) {
    const auto& [body, axis, kind] = key;
    const Body& of = problem.bodies[std::size_t(body)];
    links.push_back({of.name, axis, count, of.link(axis, kind)});
  }
  const auto first_extra = std::ptrdiff_t(links.size());
  for (const ExtraLink& link : problem.extra_links) {
    const auto alike =
        std::find_if(links.begin() + first_extra, links.end(), [&](const LinkSummary& other) {
          return other.axis == link.axis && other.constants == link.constants;
        });
    if (alike != links.end())
      ++alike->count;
    else
      links.push_back({"(extra links)", link.axis, 1, link.constants});
  }
  return links;
}

std::vector<PressureSummary> summarize_pressures(const Problem& problem) {
  std::vector<PressureSummary> all;
  if (!problem.has_pressure()) return all;
  std::map<std::pair<int, int>, std::size_t> counts;
  problem.lattice.for_each_element([&](std::size_t e, const Row& row, int) {
    ++counts[{row.body, problem.pressure_kinds[e]}];
  });
  for (const auto& [key, count] : counts)
    if (const Body& body = problem.bodies[std::size_t(key.first)]; !body.pressures.empty())
      all.push_back({body.name, count, body.pressures[std::size_t(key.second)]});
  return all;
}

nlohmann::ordered_json pressures_json(const std::vector<PressureSummary>& pressures) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const PressureSummary& one : pressures)
    list.push_back({{"body", one.body},
                    {"count", one.count},
                    {"volume_pa", one.constants.volume},
                    {"bending_n", one.constants.bending}});
  return list;
}

std::string pressures_text(const std::vector<PressureSummary>& pressures) {
  std::vector<std::vector<std::string>> rows;
  for (const PressureSummary& one : pressures) {
    std::vector<std::string> row = {one.body, std::to_string(one.count),
                                    fmt::format("{:.6g}", one.constants.volume)};
    for (const double bending : one.constants.bending)
      row.push_back(bending == 0 ? "" : fmt::format("{:.6g}", bending));
    rows.push_back(row);
  }
  return "pressures of elements, from nu: resistance to changes of volume [Pa], and of curvature "
         "about the normal of a plate [N]\n" +
         text_table({"body", "count", "volume", "bending_x", "bending_y", "bending_z"}, rows);
}

nlohmann::ordered_json links_json(const std::vector<LinkSummary>& links) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const LinkSummary& link : links) {
    const AxisConstants& c = link.constants;
    list.push_back({{"body", link.body},
                    {"axis", std::string(1, "xyz"[link.axis])},
                    {"count", link.count},
                    {"k_normal_n_per_m", c.k_normal},
                    {"k_shear_n_per_m", c.k_shear},
                    {"k_rot_n_m_per_rad", c.k_rot},
                    {"d_normal_n_s_per_m", c.d_normal},
                    {"d_shear_n_s_per_m", c.d_shear},
                    {"d_rot_n_m_s_per_rad", c.d_rot}});
  }
  return list;
}

std::string links_text(const std::vector<LinkSummary>& links) {
  std::vector<std::vector<std::string>> rows;
  for (const LinkSummary& link : links) {
    const AxisConstants& c = link.constants;
    std::vector<std::string> row = {link.body, std::string(1, "xyz"[link.axis]),
                                    std::to_string(link.count), fmt::format("{:.6g}", c.k_normal)};
    for (std::size_t a = 0; a < 3; ++a)
      row.push_back(a == std::size_t(link.axis) ? "" : fmt::format("{:.6g}", c.k_shear[a]));
    for (const double k : c.k_rot) row.push_back(fmt::format("{:.6g}", k));
    rows.push_back(row);
  }
  return "constants of links: k_normal and k_shear [N/m], k_rot [N m/rad]\n" +
         text_table({"body", "along", "count", "k_normal", "k_shear_x", "k_shear_y", "k_shear_z",
                     "k_rot_x", "k_rot_y", "k_rot_z"},
                    rows);
}

} // namespace dss
