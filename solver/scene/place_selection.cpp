#include "solver/scene/place_selection.hpp"

#include "solver/scene/cad_face.hpp"

#include <Eigen/Geometry>

namespace dss {

const std::vector<std::string> place_keys = {"region", "plane", "cylinder", "cad_face"};

namespace {

using Eigen::Vector3d;

Vector3d point_of(const Node& node) {
  const Vec3 point = node.vector();
  return {point[0], point[1], point[2]};
}

/// The elements of a body whose centre passes a test. @param test  of a place: bool
template <class Test>
std::vector<std::size_t> elements_where(const Problem& problem, int body, Test&& test) {
  std::vector<std::size_t> elements;
  problem.lattice.for_each_element([&](std::size_t element, const Row& row, int x) {
    if (row.body != body) return;
    const Vec3 place = rest_position(problem, row, x);
    if (test(Vector3d(place[0], place[1], place[2]))) elements.push_back(element);
  });
  return elements;
}

Vector3d edge_of(const Problem& problem, int body) {
  const Vec3& edge = problem.bodies[std::size_t(body)].edge;
  return {edge[0], edge[1], edge[2]};
}

std::vector<std::size_t> read_region(const Node& node, const Problem& problem, int body) {
  ObjectNode region(node);
  const Vector3d from = point_of(region.require("from")), to = point_of(region.require("to"));
  region.finish();
  if ((from.array() > to.array()).any())
    node.fail("\"from\" is beyond \"to\"; give the low corner and the high corner [m]");
  return elements_where(problem, body, [&](const Vector3d& place) {
    return (place.array() >= from.array()).all() && (place.array() <= to.array()).all();
  });
}

std::vector<std::size_t> read_plane(const Node& node, const Problem& problem, int body) {
  ObjectNode plane(node);
  const Vector3d point = point_of(plane.require("point"));
  const Node direction = plane.require("normal");
  plane.finish();
  const Vector3d given = point_of(direction);
  if (given.isZero(0)) direction.fail("a normal is not [0, 0, 0]");
  const Vector3d normal = given.normalized();
  const double reach = normal.cwiseAbs().dot(edge_of(problem, body)) / 2;
  // Rounding does not decide about a layer whose face is the plane.
  const double slack = 1e-9 * reach;
  return elements_where(problem, body, [&](const Vector3d& place) {
    const double distance = normal.dot(place - point);
    return distance > -reach + slack && distance <= reach + slack;
  });
}

std::vector<std::size_t> read_cylinder(const Node& node, const Problem& problem, int body) {
  ObjectNode cylinder(node);
  const Vector3d from = point_of(cylinder.require("from")), to = point_of(cylinder.require("to"));
  const double radius = cylinder.require("radius").positive();
  cylinder.finish();
  const Vector3d axis = to - from;
  if (axis.isZero(0)) node.fail("\"from\" and \"to\" are the same; give both ends of the axis [m]");
  return elements_where(problem, body, [&](const Vector3d& place) {
    const double along = axis.dot(place - from) / axis.squaredNorm();
    return along >= 0 && along <= 1 && (place - from - along * axis).norm() <= radius;
  });
}

} // namespace

std::vector<std::size_t> read_place(const std::string& key, const Node& node,
                                    const Problem& problem, int body,
                                    const std::optional<Surface>& surface) {
  if (key == "region") return read_region(node, problem, body);
  if (key == "plane") return read_plane(node, problem, body);
  if (key == "cylinder") return read_cylinder(node, problem, body);
  return read_cad_face(node, problem, body, surface);
}

} // namespace dss
