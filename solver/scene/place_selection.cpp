#include "solver/scene/place_selection.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

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

/// Square of the distance between a point and a triangle (Ericson, Real-Time Collision Detection,
/// 5.1.5).
double square_distance(const Vector3d& p, const std::array<Vector3d, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  const Vector3d ab = b - a, ac = c - a, normal = ab.cross(ac);
  const auto to_edge = [&](const Vector3d& from, const Vector3d& edge) {
    const double along = std::clamp((p - from).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    return (p - from - along * edge).squaredNorm();
  };
  const bool is_above = normal.dot(ab.cross(p - a)) >= 0 && normal.dot((c - b).cross(p - b)) >= 0 &&
                        normal.dot((a - c).cross(p - c)) >= 0;
  if (is_above && !normal.isZero(0)) {
    const double height = normal.dot(p - a);
    return height * height / normal.squaredNorm();
  }
  return std::min({to_edge(a, ab), to_edge(b, c - b), to_edge(c, a - c)});
}

/// The triangles of the face next to a point.
std::vector<std::uint32_t> face_next_to(const Surface& surface, const Vector3d& point,
                                        double angle) {
  std::uint32_t first = 0;
  double least = square_distance(point, surface.corners_of(0));
  for (std::uint32_t t = 1; t < surface.triangles.size(); ++t)
    if (const double square = square_distance(point, surface.corners_of(t)); square < least)
      first = t, least = square;
  const auto neighbours = triangle_neighbours(surface);
  const double cosine = std::cos(angle * std::numbers::pi / 180);
  std::vector<std::uint8_t> is_taken(surface.triangles.size());
  std::vector<std::uint32_t> face = {first};
  is_taken[first] = 1;
  for (std::size_t n = 0; n < face.size(); ++n) {
    const std::uint32_t t = face[n];
    const Vector3d normal = surface.area_of(t).normalized();
    for (const std::uint32_t next : neighbours[t]) {
      if (is_taken[next] != 0 || normal.dot(surface.area_of(next).normalized()) <= cosine) continue;
      is_taken[next] = 1;
      face.push_back(next);
    }
  }
  return face;
}

std::vector<std::size_t> read_cad_face(const Node& node, const Problem& problem, int body,
                                       const std::optional<Surface>& surface) {
  const Body& own = problem.bodies[std::size_t(body)];
  if (!surface)
    node.fail(
        fmt::format("body \"{}\" has no CAD surface; its \"geometry\" is not \"stl\"", own.name));
  ObjectNode face(node);
  const Vector3d near = point_of(face.require("near"));
  const double angle = face.positive_or("angle", 30);
  face.finish();
  const Vector3d edge = edge_of(problem, body), low(own.origin[0], own.origin[1], own.origin[2]);
  const double reach = edge.norm() / 2;
  // Cells that some triangle passes closely enough, by their places in the grid.
  const std::vector<std::uint32_t> triangles = face_next_to(*surface, near, angle);
  using Cell = std::array<int, 3>;
  std::vector<Cell> cells;
  for (const std::uint32_t t : triangles) {
    const auto corners = surface->corners_of(t);
    const Vector3d first = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]),
                   last = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
    const auto cell_of = [&](const Vector3d& place, double shift) {
      const Vector3d cell = ((place.array() + shift - low.array()) / edge.array()).floor();
      return Cell{int(cell[0]), int(cell[1]), int(cell[2])};
    };
    const Cell begin = cell_of(first, -reach), end = cell_of(last, reach);
    for (int z = begin[2]; z <= end[2]; ++z)
      for (int y = begin[1]; y <= end[1]; ++y)
        for (int x = begin[0]; x <= end[0]; ++x) {
          const Vector3d centre = low + edge.cwiseProduct(Vector3d(x + 0.5, y + 0.5, z + 0.5));
          if (square_distance(centre, corners) <= reach * reach) cells.push_back({z, y, x});
        }
  }
  std::ranges::sort(cells);
  std::vector<std::size_t> elements;
  problem.lattice.for_each_element([&](std::size_t element, const Row& row, int x) {
    if (row.body == body && std::ranges::binary_search(cells, Cell{row.z, row.y, x}))
      elements.push_back(element);
  });
  return elements;
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
