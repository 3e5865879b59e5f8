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
