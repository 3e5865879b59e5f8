#include "solver/model/sufficiency/sufficiency.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <map>
#include <tuple>
#include <utility>

namespace dss {
namespace {

/// Numbers keys in the order in which they first appear.
template <class Key>
class Numbers {
public:
  int of(const Key& key) { return numbers_.try_emplace(key, int(numbers_.size())).first->second; }
  std::size_t count() const { return numbers_.size(); }

private:
  std::map<Key, int> numbers_;
};

/// Colour of each element without its neighbours: elements of one colour have the same clamp,
/// loads, kind of link and start in the equations along x.
std::vector<int> element_colours(const Problem& problem) {
  std::vector<int> colours(problem.lattice.element_count, 0);
  const auto refine = [&](const auto& elements, const auto& mark_of) {
    Numbers<std::pair<int, decltype(mark_of(0))>> numbers;
    const int offset = *std::ranges::max_element(colours);
    for (const std::size_t e : elements)
      colours[e] = offset + 1 + numbers.of({colours[e], mark_of(e)});
  };
  std::vector<std::size_t> clamped;
  for (const Clamp& clamp : problem.clamps)
    if (clamp.dofs & dof_ux) clamped.push_back(clamp.element);
  refine(clamped, [](std::size_t) { return 1; });
  for (const Load& load : problem.loads)
    if (load.force[0] != 0 && !is_zero_always(load.signal))
      refine(load.elements, [](std::size_t) { return 1; });
  std::vector<std::size_t> all(colours.size());
  for (std::size_t e = 0; e < all.size(); ++e) all[e] = e;
  if (!problem.link_kinds.empty()) {
    std::vector<std::pair<double, double>> along(colours.size()); // of each element's upper link
    problem.lattice.for_each_element([&](std::size_t e, const Row& row, int) {
      const AxisConstants& link =
          problem.bodies[std::size_t(row.body)].link(0, problem.link_kind(e, 0));
      along[e] = {link.k_normal, link.d_normal};
    });
    refine(all, [&](std::size_t e) { return along[e]; });
  }
  if (problem.initial_motions.empty()) return colours;
  const std::vector<double> state = initial_state(problem);
  refine(all, [&](std::size_t e) {
    return std::pair(state[e * field_count + ux], state[e * field_count + vx]);
  });
  return colours;
}

struct Cell {
  std::size_t row;
  int x;
};

Cell cell_of(const Problem& problem, std::size_t element) {
  const std::vector<Row>& rows = problem.lattice.rows;
  const auto after =
      std::upper_bound(rows.begin(), rows.end(), element,
                       [](std::size_t e, const Row& row) { return e < row.first_element; });
  const Row& row = *(after - 1);
  std::size_t e = row.first_element;
  int x = row.x_begin;
  while (!problem.lattice.is_present(row, x) || e++ != element) ++x;
  return {std::size_t(&row - rows.data()), x};
}

using LinkConstants = std::tuple<int, double, double, Vec3, Vec3>;
LinkConstants constants_of(const ExtraLink& link) {
  return {int(link.law), link.constants.k_normal, link.constants.d_normal, link.constants.k_shear,
          link.constants.d_shear};
}

/// Class of each row. Rows of one class have the same equations along x, and their links lead to
/// rows of equal classes, so they move alike. Colour refinement: the coarsest partition that is
/// stable under the extra links, which are all along x here.
std::vector<int> row_classes(const Problem& problem) {
  const Lattice& lattice = problem.lattice;
  const std::vector<int> colours = element_colours(problem);
  std::vector<int> classes(lattice.rows.size());
  Numbers<std::vector<int>> contents;
  for (std::size_t r = 0; r < classes.size(); ++r) {
    const Row& row = lattice.rows[r];
    std::vector<int> content{row.body, row.x_begin};
    std::size_t e = row.first_element;
    for (int x = row.x_begin; x < row.x_end; ++x)
      content.push_back(lattice.is_present(row, x) ? colours[e++] : -1);
    classes[r] = contents.of(content);
  }
  // Place on the row, end of the link, class and place of the partner, constants of the link.
  using Joint = std::tuple<int, int, int, int, LinkConstants>;
  for (std::size_t before = 0, now = contents.count();
       before != now && !problem.extra_links.empty();) {
    std::vector<std::vector<Joint>> joints(classes.size());
    for (const ExtraLink& link : problem.extra_links) {
      const Cell i = cell_of(problem, link.i), j = cell_of(problem, link.j);
      joints[i.row].emplace_back(i.x, 0, classes[j.row], j.x, constants_of(link));
      joints[j.row].emplace_back(j.x, 1, classes[i.row], i.x, constants_of(link));
    }
    Numbers<std::pair<int, std::vector<Joint>>> numbers;
    for (std::size_t r = 0; r < classes.size(); ++r) {
      std::ranges::sort(joints[r]);
      classes[r] = numbers.of({classes[r], joints[r]});
    }
    before = std::exchange(now, numbers.count());
  }
  return classes;
}

bool are_linked(const Lattice& lattice, const Row& a, const Row& b) {
  for (int x = std::max(a.x_begin, b.x_begin); x < std::min(a.x_end, b.x_end); ++x)
    if (lattice.is_present(a, x) && lattice.is_present(b, x)) return true;
  return false;
}

std::string rows_that_differ(const Problem& problem) {
  const std::vector<Row>& rows = problem.lattice.rows;
  if (std::ranges::all_of(rows, [](const Row& row) { return row.upper_y < 0 && row.upper_z < 0; }))
    return {};
  const std::vector<int> classes = row_classes(problem);
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (const int upper : {rows[r].upper_y, rows[r].upper_z}) {
      if (upper < 0 || classes[r] == classes[std::size_t(upper)]) continue;
      const Row &row = rows[r], &other = rows[std::size_t(upper)];
      if (are_linked(problem.lattice, row, other))
        return fmt::format("rows (y, z) = ({}, {}) and ({}, {}) of body \"{}\" need not move "
                           "alike: their links shear, "
                           "which turns elements",
                           row.y, row.z, other.y, other.z,
                           problem.bodies[std::size_t(row.body)].name);
    }
  return {};
}

std::string links_across(const Problem& problem) {
  for (std::size_t l = 0; l < problem.extra_links.size(); ++l)
    if (const ExtraLink& link = problem.extra_links[l]; link.axis != 0)
      return fmt::format("extra link {} between elements {} and {} is along {}: it shears", l,
                         link.i, link.j, "xyz"[link.axis]);
  return {};
}

std::string pressure_across(const Problem& problem) {
  for (const Body& body : problem.bodies)
    if (!body.pressures.empty() && std::ranges::any_of(body.pressures, [](const auto& pressure) {
          return pressure.volume != 0;
        }))
      return fmt::format("body \"{}\" contracts across x, because its nu is not 0", body.name);
  return {};
}

} // namespace

// Clamps need no check: a clamp of another degree of freedom holds something that does not move.
std::string why_not_axial(const Problem& problem) {
  for (std::string reason :
       {load_along(problem, {1, 2}, {0, 1, 2}), acceleration_along(problem, {1, 2}),
        start_with(problem, {uy, uz, vy, vz, qs, qx, qy, qz, wx, wy, wz}), links_across(problem),
        pressure_across(problem)})
    if (!reason.empty()) return reason;
  return rows_that_differ(problem);
}

} // namespace dss
