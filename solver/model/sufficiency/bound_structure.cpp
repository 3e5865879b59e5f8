#include "solver/model/sufficiency/bound_structure.hpp"
#include "solver/model/pressed_link.hpp"
#include "solver/model/sufficiency/sufficiency.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

namespace dss {
namespace {

/// Sets of linked elements (union-find). All elements clamped in every degree of freedom count as
/// one.
class Pieces {
public:
  explicit Pieces(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t(0));
  }
  /// @return true if a and b were in different sets
  bool join(std::size_t a, std::size_t b) {
    a = root(a), b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }
  std::size_t root(std::size_t e) {
    while (parent_[e] != e) e = parent_[e] = parent_[parent_[e]];
    return e;
  }

private:
  std::vector<std::size_t> parent_;
};

/// Visits the constants of all kinds of links, with the stiffness of their elements' pressures in
/// k_normal.
template <class Visit>
void for_each_link_kind(const Problem& problem, const Visit& visit) {
  std::vector<int> body_of(problem.lattice.element_count);
  std::vector<std::size_t> first_kind; // of each body
  std::size_t kinds = 0;
  for (const Body& body : problem.bodies) first_kind.push_back(kinds), kinds += body.kinds();
  std::vector<bool> met(3 * kinds);
  problem.lattice.for_each_element(
      [&](std::size_t e, const Row& row, int) { body_of[e] = row.body; });
  problem.lattice.for_each_link([&](std::size_t i, std::size_t, int axis) {
    const auto body = std::size_t(body_of[i]);
    const std::size_t kind = problem.link_kind(i, axis);
    const std::size_t place = 3 * (first_kind[body] + kind) + std::size_t(axis);
    if (met[place]) return;
    met[place] = true;
    const Body& b = problem.bodies[body];
    AxisConstants constants = b.link(axis, kind);
    constants.k_normal += largest_pressed_link(b, axis).normal;
    visit(b.law, axis, constants, b.edge[std::size_t(axis)]);
  });
  for (const ExtraLink& link : problem.extra_links) {
    const auto a = std::size_t(link.axis);
    visit(link.law, link.axis, link.constants,
          (problem.bodies[std::size_t(body_of[link.i])].edge[a] +
           problem.bodies[std::size_t(body_of[link.j])].edge[a]) /
              2);
  }
}

void look_at_connections(const Problem& problem, BoundStructure& structure) {
  const std::size_t count = problem.lattice.element_count;
  Pieces pieces(count);
  std::vector<bool> is_held(count);
  structure.is_tree = true;
  for (const Clamp& clamp : problem.clamps)
    if (clamp.dofs == dof_all)
      is_held[clamp.element] = true;
    else
      // A partial clamp may restrain a motion that a tree of links leaves free.
      structure.is_tree = false;
  const auto first_held =
      std::size_t(std::find(is_held.begin(), is_held.end(), true) - is_held.begin());
  for (std::size_t e = 0; e < count; ++e)
    if (is_held[e]) pieces.join(first_held, e);
  const auto join = [&](std::size_t i, std::size_t j) {
    if (!pieces.join(i, j) && !(is_held[i] && is_held[j])) structure.is_tree = false;
  };
  problem.lattice.for_each_link([&](std::size_t i, std::size_t j, int) { join(i, j); });
  for (const ExtraLink& link : problem.extra_links) join(link.i, link.j);
  structure.is_held = first_held < count;
  for (std::size_t e = 0; e < count && structure.is_held; ++e)
    structure.is_held = pieces.root(e) == pieces.root(first_held);
}

/// Upper bound of the longest path through the bodies [m]. If a body fills its bounding box: the
/// sum of the box's edges. Otherwise the path may wind: the length of all elements in one line.
double longest_way(const Problem& problem) {
  std::vector<long> elements(problem.bodies.size());
  problem.lattice.for_each_element(
      [&](std::size_t, const Row& row, int) { ++elements[std::size_t(row.body)]; });
  std::vector<std::array<int, 6>> extents(problem.bodies.size(),
                                          {1 << 30, -1, 1 << 30, -1, 1 << 30, -1});
  for (const Row& row : problem.lattice.rows) {
    auto& extent = extents[std::size_t(row.body)];
    const std::array<std::pair<int, int>, 3> ends{
        {{row.x_begin, row.x_end}, {row.y, row.y + 1}, {row.z, row.z + 1}}};
    for (std::size_t a = 0; a < 3; ++a) {
      extent[2 * a] = std::min(extent[2 * a], ends[a].first);
      extent[2 * a + 1] = std::max(extent[2 * a + 1], ends[a].second);
    }
  }
  double longest = 0, sum = 0;
  for (std::size_t b = 0; b < extents.size(); ++b) {
    double way = 0;
    long cells = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      const int extent = extents[b][2 * a + 1] - extents[b][2 * a];
      way += problem.bodies[b].edge[a] * extent;
      cells *= extent;
    }
    if (cells != elements[b])
      way = double(elements[b]) * *std::ranges::max_element(problem.bodies[b].edge);
    longest = std::max(longest, way);
    sum += way;
  }
  return problem.extra_links.empty() ? longest : sum;
}

} // namespace

BoundStructure bound_structure(const Problem& problem) {
  BoundStructure structure;
  structure.is_flat = why_not_bending(problem).empty();
  look_at_connections(problem, structure);
  structure.length = longest_way(problem);
  constexpr double endless = std::numeric_limits<double>::infinity();
  structure.mass = structure.inertia = endless;
  structure.shortest_edge = shortest_edge(problem);
  for (const Body& body : problem.bodies) {
    structure.edge = std::max(structure.edge, *std::ranges::max_element(body.edge));
    const double ratio = body.mass_ratios.empty() ? 1 : std::ranges::min(body.mass_ratios);
    structure.mass = std::min(structure.mass, ratio * body.mass);
    structure.inertia = std::min(structure.inertia, ratio * std::ranges::min(body.inertia));
  }
  // Inverse of the least buckling load [1/N].
  double yielding = 0;
  for_each_link_kind(problem, [&](LinkLaw law, int axis, const AxisConstants& c, double edge) {
    structure.stiffness = std::max(structure.stiffness, c.k_normal);
    double k_bend = law == LinkLaw::paper ? c.k_rot[0] : endless;
    for (std::size_t m = 0; m < 3 && law != LinkLaw::paper; ++m)
      if (int(m) != axis) k_bend = std::min(k_bend, c.k_rot[m]);
    const double column = 2 * structure.length / std::numbers::pi;
    const auto [base, third] = shear_axes(axis);
    const double k_shear = std::min(c.k_shear[base], c.k_shear[third]);
    yielding = std::max(yielding, column * column / (k_bend * edge) + 1 / (k_shear * edge));
  });
  structure.least_buckling = yielding > 0 ? 1 / yielding : endless;
  if (structure.least_buckling == 0) structure.is_held = false;
  return structure;
}

} // namespace dss
