#include "solver/scene/density_loads.hpp"

#include "solver/memory.hpp"
#include "solver/scene/cad_face.hpp"
#include "solver/scene/selection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

namespace dss {

const std::vector<std::string> density_keys = {"traction", "pressure", "body_force"};

namespace {

/// A force an area or volume.
class Density {
public:
  Density(const Node& node, bool is_pressure) : is_pressure_(is_pressure) {
    if (is_pressure) {
      add(node);
    } else {
      if (!node.is_array() || node.items().size() != parts_.size()) node.vector(); // fails
      for (const Node& part : node.items()) add(part);
    }
  }
  bool is_of_place() const { return is_of_place_; }
  /// @param normal  the outer one of the face that a pressure pushes
  Vec3 at(const Vec3& place, const Vec3& normal) const {
    if (!is_pressure_) return {parts_[0](place), parts_[1](place), parts_[2](place)};
    const double pressure = parts_[0](place);
    return {-pressure * normal[0], -pressure * normal[1], -pressure * normal[2]};
  }

private:
  void add(const Node& node) {
    PlaceFunction& part = parts_[count_++];
    part = node.function_of_place();
    is_of_place_ |= part != nullptr;
    if (!part) part = [number = node.number()](const Vec3&) { return number; };
  }

  bool is_pressure_, is_of_place_ = false;
  std::array<PlaceFunction, 3> parts_;
  std::size_t count_ = 0;
};

/// Where a density acts on each of some elements.
struct Side {
  std::vector<std::size_t> elements; ///< ascending
  int face = -1;                     ///< as Load::face
};

/// The load on a side at a place, for the body's elements.
Load load_at(const Vec3& place, const Side& side, const Density& density, const Body& body) {
  Load load;
  load.face = side.face;
  Vec3 normal{}, arm{};
  double size = body.edge[0] * body.edge[1] * body.edge[2]; // [m^3], or [m^2] of a face
  if (side.face >= 0) {
    const auto axis = std::size_t(side.face) / 2;
    normal[axis] = side.face % 2 == 1 ? 1 : -1;
    arm[axis] = normal[axis] * body.edge[axis] / 2;
    size = body.edge[(axis + 1) % 3] * body.edge[(axis + 2) % 3];
  }
  const Vec3 f = density.at({place[0] + arm[0], place[1] + arm[1], place[2] + arm[2]}, normal);
  load.force = {size * f[0], size * f[1], size * f[2]};
  load.torque = {arm[1] * load.force[2] - arm[2] * load.force[1],
                 arm[2] * load.force[0] - arm[0] * load.force[2],
                 arm[0] * load.force[1] - arm[1] * load.force[0]};
  return load;
}

/// A load of its own for each element of a side.
void add_by_place(const Side& side, const Density& density, const Problem& problem,
                  const Body& body, std::vector<Load>& loads) {
  problem.lattice.for_each_element([&](std::size_t e, const Row& row, int x) {
    if (!std::ranges::binary_search(side.elements, e)) return;
    loads.push_back(load_at(rest_position(problem, row, x), side, density, body));
    loads.back().elements = {e};
  });
}

/// Each load has a signal of its own in every row of signals, and rows of elements look at all of
/// their loads.
void require_few(std::size_t loads, const Node& node) {
  constexpr std::size_t most = 100'000;
  if (loads > most)
    node.fail(fmt::format("depends on the place of {} elements, at most {} can have loads of their "
                          "own; select fewer, or give a number",
                          loads, most));
  constexpr double rows = 1024; // of signals, that a run has at once
  require_memory(8 * rows * double(loads),
                 fmt::format("{}: the signals of {} loads", node.where(), loads),
                 "select fewer elements, or give a number");
}

/// The faces or elements that "select" names.
std::vector<Side> read_sides(ObjectNode& object, bool is_volume, bool is_pressure,
                             const Problem& problem, int body, const BodySurfaces& surfaces) {
  std::vector<Side> sides;
  ObjectNode select(object.require("select"));
  const auto cad_face = select.find("cad_face");
  if (cad_face && is_pressure) {
    select.require_one({"cad_face", "face"});
    select.finish();
    auto by_face = read_cad_sides(*cad_face, problem, body, surfaces[std::size_t(body)]);
    for (std::size_t face = 0; face < by_face.size(); ++face)
      if (!by_face[face].empty()) sides.push_back({std::move(by_face[face]), int(face)});
    if (sides.empty()) cad_face->fail("selects nothing: no free face of an element lies there");
    return sides;
  }
  const auto face = selected_face(object);
  if (!is_volume && !face)
    object.fail("a traction or pressure acts on faces; select a \"face\", such as \"+x\", or "
                "for a pressure a \"cad_face\"");
  return {{read_selected(object, problem, surfaces, false), is_volume ? -1 : int(*face)}};
}

} // namespace

std::vector<Load> read_density_loads(ObjectNode& object, const Problem& problem, int body,
                                     const BodySurfaces& surfaces) {
  const std::string key = object.require_one(density_keys);
  const Node node = object.require(key);
  const bool is_pressure = key == "pressure";
  const Density density(node, is_pressure);
  const Body& own = problem.bodies[std::size_t(body)];
  std::vector<Load> loads;
  for (Side& side : read_sides(object, key == "body_force", is_pressure, problem, body, surfaces)) {
    if (density.is_of_place()) {
      require_few(side.elements.size(), node);
      add_by_place(side, density, problem, own, loads);
      continue;
    }
    loads.push_back(load_at({}, side, density, own));
    loads.back().elements = std::move(side.elements);
  }
  return loads;
}

} // namespace dss
