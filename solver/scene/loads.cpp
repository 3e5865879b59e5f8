#include "solver/scene/loads.hpp"

#include "solver/memory.hpp"
#include "solver/model/element_place.hpp"
#include "solver/scene/density_loads.hpp"
#include "solver/scene/selection.hpp"
#include "solver/scene/signals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <utility>
#include <vector>

namespace dss {
namespace {

Vec3 scaled(double factor, const Vec3& v) { return {factor * v[0], factor * v[1], factor * v[2]}; }
Vec3 sum(const Vec3& v, const Vec3& w) { return {v[0] + w[0], v[1] + w[1], v[2] + w[2]}; }
Vec3 cross(const Vec3& v, const Vec3& w) {
  return {v[1] * w[2] - v[2] * w[1], v[2] * w[0] - v[0] * w[2], v[0] * w[1] - v[1] * w[0]};
}

/// A force that acts at the end of an arm from the centres of elements.
void set_force_at(const Vec3& arm, const Vec3& force, Load& load) {
  load.force = force;
  load.torque = sum(load.torque, cross(arm, force));
}

/// "force" and "torque", on each selected element or shared among them.
void read_wrench(ObjectNode& object, Load& load) {
  load.force = object.vector_or("force", {});
  load.torque = object.vector_or("torque", {});
  const auto share = object.find("share");
  if (!share || share->choice("share", {"each", "total"}) == 0) return;
  const double part = 1 / double(load.elements.size());
  load.force = scaled(part, load.force);
  load.torque = scaled(part, load.torque);
}

/// A load on selected elements.
Load read_selected_load(ObjectNode& object, const Problem& problem, const BodySurfaces& surfaces) {
  Load load;
  load.elements = read_selected(object, problem, surfaces, false);
  if (const auto face = selected_face(object)) load.face = int(*face);
  read_wrench(object, load);
  return load;
}

/// "at": a force and a torque at a point of the body.
Load read_point_load(ObjectNode& object, const Node& at, const Problem& problem, int body) {
  const NearestPlace place = nearest_place(problem, body, at.vector());
  if (place.distance > 1e-6 * shortest_edge(problem))
    at.fail(fmt::format("is {:.3g} m outside of body \"{}\"", place.distance,
                        problem.bodies[std::size_t(body)].name));
  Load load;
  load.elements = {place.element};
  load.torque = object.vector_or("torque", {});
  set_force_at(place.arm, object.vector_or("force", {}), load);
  return load;
}

/// Part of a segment that lies in an element: from `first` to `last`, of 0 to 1.
struct Part {
  std::size_t element = 0;
  Vec3 centre{};
  double first = 0, last = 1;
};

/// Cuts a part to the box of its element. Boxes are wider by a millionth of their edges, so that a
/// segment on their surface is in them.
void cut_to_box(const Vec3& from, const Vec3& to, const Vec3& edge, Part& part) {
  constexpr double width = 1e-6;
  for (std::size_t a = 0; a < 3; ++a) {
    const double low = part.centre[a] - (0.5 + width) * edge[a] - from[a],
                 high = low + (1 + 2 * width) * edge[a], along = to[a] - from[a];
    if (std::abs(along) <= width * edge[a]) {
      if (low > 0 || high < 0) part.last = -1;
      continue;
    }
    part.first = std::max(part.first, std::min(low / along, high / along));
    part.last = std::min(part.last, std::max(low / along, high / along));
  }
}

std::vector<Part> parts_of_line(const Vec3& from, const Vec3& to, const Problem& problem,
                                int body) {
  std::vector<Part> parts;
  problem.lattice.for_each_element([&](std::size_t e, const Row& row, int x) {
    if (row.body != body) return;
    Part part{e, rest_position(problem, row, x)};
    cut_to_box(from, to, problem.bodies[std::size_t(body)].edge, part);
    if (part.last > part.first) parts.push_back(part);
  });
  return parts;
}

/// Spreads a force evenly over a segment. Each element takes the force of its part, in the middle
/// of it; elements that have a part together share it.
/// @param covered  output: the part of the segment that is in some element
std::vector<Load> loads_of_line(const Vec3& from, const Vec3& to, const Vec3& force,
                                const std::vector<Part>& parts, double& covered) {
  std::vector<double> ends;
  std::map<std::size_t, Load> loads;
  for (const Part& part : parts) {
    ends.insert(ends.end(), {part.first, part.last});
    loads[part.element].elements = {part.element};
  }
  std::ranges::sort(ends);
  covered = 0;
  for (std::size_t n = 1; n < ends.size(); ++n) {
    const double length = ends[n] - ends[n - 1], middle = (ends[n] + ends[n - 1]) / 2;
    const auto is_here = [&](const Part& p) { return p.first < middle && middle < p.last; };
    const auto count = std::ranges::count_if(parts, is_here);
    if (count == 0) continue;
    covered += length;
    for (const Part& part : parts) {
      if (!is_here(part)) continue;
      Vec3 arm{};
      for (std::size_t a = 0; a < 3; ++a)
        arm[a] = from[a] + middle * (to[a] - from[a]) - part.centre[a];
      const Vec3 share = scaled(length / double(count), force);
      Load& load = loads[part.element];
      load.force = sum(load.force, share);
      load.torque = sum(load.torque, cross(arm, share));
    }
  }
  std::vector<Load> all;
  for (auto& [element, load] : loads) all.push_back(std::move(load));
  return all;
}

/// "line": a force that is spread evenly over a segment.
std::vector<Load> read_line_load(ObjectNode& object, const Node& line, const Problem& problem,
                                 int body) {
  ObjectNode ends(line);
  const Vec3 from = ends.require("from").vector(), to = ends.require("to").vector();
  ends.finish();
  const Vec3 force = object.require("force").vector();
  if (from == to) line.fail("has no length; give \"at\" for a force at a point");
  double covered = 0;
  std::vector<Load> loads =
      loads_of_line(from, to, force, parts_of_line(from, to, problem, body), covered);
  if (covered < 1 - 1e-4)
    line.fail(fmt::format("is outside of body \"{}\" over {:.3g} % of its length",
                          problem.bodies[std::size_t(body)].name, 100 * (1 - covered)));
  return loads;
}

/// Requires one kind of load, at one kind of place.
void require_kind(ObjectNode& object) {
  std::vector<std::string> kinds;
  const bool is_wrench = object.has("force") || object.has("torque");
  if (is_wrench) kinds.emplace_back("force or torque");
  for (const std::string& kind : density_keys)
    if (object.node().json().contains(kind)) kinds.push_back(kind);
  if (kinds.empty())
    object.fail("a load needs \"force\" or \"torque\", \"traction\", \"pressure\" or "
                "\"body_force\"");
  if (kinds.size() > 1)
    object.fail(fmt::format("{} exclude each other; give one of them", listed(kinds)));
  if (object.require_one({"select", "at", "line"}) != "select" && !is_wrench)
    object.fail(fmt::format("at a point or along a line a load has a \"force\"; \"{}\" needs "
                            "\"select\"",
                            kinds.front()));
}

/// Sets what loads on free faces add to the strains of elements. It depends on their material, so a
/// load becomes one for each.
std::vector<Load> with_face_strains(const std::vector<Load>& loads, const BodyMaterials& solid,
                                    const Vec3& edge, const Problem& problem) {
  std::vector<Load> split;
  for (const Load& load : loads) {
    if (load.face < 0 || solid.count() == 1) {
      split.push_back(load);
      if (load.face >= 0) set_face_strain(solid.of(1), edge, split.back());
      continue;
    }
    for (const auto& one : solid.all()) {
      const int number = one.first;
      const Material& material = one.second;
      Load part = load;
      std::erase_if(part.elements, [&](std::size_t e) { return problem.material(e) != number; });
      if (part.elements.empty()) continue;
      if (material.nu > 0) set_face_strain(material, edge, part);
      split.push_back(std::move(part));
    }
  }
  return split;
}

std::vector<Load> read_load(const Node& node, const Solids& solids, const BodySurfaces& surfaces,
                            const Problem& problem) {
  ObjectNode object(node);
  const int body = read_body(object, problem);
  const Body& own = problem.bodies[std::size_t(body)];
  require_kind(object);
  std::vector<Load> loads;
  if (const auto at = object.find("at"))
    loads = {read_point_load(object, *at, problem, body)};
  else if (const auto line = object.find("line"))
    loads = read_line_load(object, *line, problem, body);
  else if (std::ranges::any_of(density_keys, [&](const auto& key) { return object.has(key); }))
    loads = read_density_loads(object, problem, body, surfaces);
  else
    loads = {read_selected_load(object, problem, surfaces)};
  if (const BodyMaterials& solid = solids.bodies[std::size_t(body)]; solid.is_contracting())
    loads = with_face_strains(loads, solid, own.edge, problem);
  if (const auto given = object.find("signal")) {
    const Signal signal = read_signal(*given, "1"); // a factor
    require_memory(16.0 * double(loads.size()) * double(signal.times.size()),
                   fmt::format("{}: the signals of {} loads", given->where(), loads.size()),
                   "give a shorter series");
    for (Load& load : loads) load.signal = signal;
  }
  object.finish();
  for (const Load& load : loads)
    for (const double number : {load.force[0], load.force[1], load.force[2], load.torque[0],
                                load.torque[1], load.torque[2]})
      if (!std::isfinite(number))
        object.fail("the force on an element is beyond the range of numbers");
  return loads;
}

} // namespace

void read_loads(const Node& node, const Solids& solids, const BodySurfaces& surfaces,
                Problem& problem) {
  for (const Node& item : node.items())
    for (Load& load : read_load(item, solids, surfaces, problem))
      problem.loads.push_back(std::move(load));
}

} // namespace dss
