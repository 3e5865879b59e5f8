#include "solver/scene/place_selection.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

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

/// The triangles of the face next to a point. Triangles without area belong to it.
/// @param distance  receives that of the nearest triangle
std::vector<std::uint32_t> face_next_to(const Surface& surface, const Vector3d& point, double angle,
                                        double& distance) {
  std::uint32_t first = 0;
  double least = square_distance(point, surface.corners_of(0));
  for (std::uint32_t t = 1; t < surface.triangles.size(); ++t)
    if (const double square = square_distance(point, surface.corners_of(t)); square < least)
      first = t, least = square;
  distance = std::sqrt(least);
  const auto neighbours = triangle_neighbours(surface);
  const double cosine = std::cos(angle * std::numbers::pi / 180);
  std::vector<std::uint8_t> is_taken(surface.triangles.size());
  std::vector<std::pair<std::uint32_t, Vector3d>> face = {
      {first, surface.area_of(first).normalized()}};
  is_taken[first] = 1;
  for (std::size_t n = 0; n < face.size(); ++n) {
    const auto [t, normal] = face[n];
    for (const std::uint32_t next : neighbours[t]) {
      const Vector3d area = surface.area_of(next);
      const Vector3d own = area.isZero(0) ? normal : area.normalized();
      if (is_taken[next] != 0 || normal.dot(own) <= cosine) continue;
      is_taken[next] = 1;
      face.emplace_back(next, own);
    }
  }
  std::vector<std::uint32_t> triangles;
  for (const auto& [t, normal] : face) triangles.push_back(t);
  return triangles;
}

/// The cells of a grid that triangles pass closely: within half of a cell's diagonal of its centre,
/// in units of cells.
class PassedCells {
public:
  using Cell = std::array<int, 3>;
  /// @param size  of the grid
  explicit PassedCells(const Cell& size)
      : size_(size),
        is_passed_(std::size_t(size[0]) * std::size_t(size[1]) * std::size_t(size[2])) {}
  /// Large triangles are halved until few cells lie around each.
  /// @param corners  in units of cells, from the corner of the grid
  void add(const std::array<Vector3d, 3>& corners) {
    constexpr double largest = 4; // cells
    std::size_t longest = 0;
    const auto side = [&](std::size_t n) { return corners[(n + 1) % 3] - corners[n]; };
    for (const std::size_t n : {1U, 2U})
      if (side(n).squaredNorm() > side(longest).squaredNorm()) longest = n;
    if (side(longest).squaredNorm() <= largest * largest) return mark(corners);
    const Vector3d middle = corners[longest] + side(longest) / 2;
    const Vector3d &from = corners[longest], &to = corners[(longest + 1) % 3],
                   &other = corners[(longest + 2) % 3];
    add({from, middle, other});
    add({middle, to, other});
  }
  bool has(int x, int y, int z) const { return is_passed_[place({x, y, z})]; }

private:
  static constexpr double reach = 0.8660254037844387; // sqrt(3) / 2
  std::size_t place(const Cell& cell) const {
    return (std::size_t(cell[2]) * std::size_t(size_[1]) + std::size_t(cell[1])) *
               std::size_t(size_[0]) +
           std::size_t(cell[0]);
  }
  void mark(const std::array<Vector3d, 3>& corners) {
    const Vector3d low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]),
                   high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
    Cell begin{}, end{};
    for (std::size_t a = 0; a < 3; ++a) {
      const double most = size_[a];
      begin[a] = int(std::clamp(std::floor(low[Eigen::Index(a)] - reach), 0.0, most));
      end[a] = int(std::clamp(std::floor(high[Eigen::Index(a)] + reach) + 1, 0.0, most));
    }
    for (int z = begin[2]; z < end[2]; ++z)
      for (int y = begin[1]; y < end[1]; ++y)
        for (int x = begin[0]; x < end[0]; ++x)
          if (square_distance({x + 0.5, y + 0.5, z + 0.5}, corners) <= reach * reach)
            is_passed_[place({x, y, z})] = true;
  }

  Cell size_;
  std::vector<bool> is_passed_;
};

/// Cells along each axis of the grid that holds a body.
PassedCells::Cell grid_size(const Lattice& lattice, int body) {
  PassedCells::Cell size{};
  for (const Row& row : lattice.rows)
    if (row.body == body)
      size = {std::max(size[0], row.x_end), std::max(size[1], row.y + 1),
              std::max(size[2], row.z + 1)};
  return size;
}

std::vector<std::size_t> read_cad_face(const Node& node, const Problem& problem, int body,
                                       const std::optional<Surface>& surface) {
  const Body& own = problem.bodies[std::size_t(body)];
  if (!surface)
    node.fail(
        fmt::format("body \"{}\" has no CAD surface; its \"geometry\" is not \"stl\"", own.name));
  ObjectNode face(node);
  const Node near = face.require("near");
  const auto angle_node = face.find("angle");
  const double angle = angle_node ? angle_node->positive() : 30;
  if (angle >= 180) angle_node->fail(fmt::format("{:g} is out of range; 0 < angle < 180", angle));
  face.finish();
  double distance = 0;
  const std::vector<std::uint32_t> triangles =
      face_next_to(*surface, point_of(near), angle, distance);
  const auto [low_corner, high_corner] = bounds(*surface);
  constexpr double nearest = 0.1; // of the diagonal
  if (distance > nearest * (high_corner - low_corner).norm())
    near.fail(
        fmt::format("is {:.3g} m from the surface of body \"{}\", which reaches from [{:.4g}, "
                    "{:.4g}, {:.4g}] to [{:.4g}, {:.4g}, {:.4g}] m; give a point next to a "
                    "face",
                    distance, own.name, low_corner[0], low_corner[1], low_corner[2], high_corner[0],
                    high_corner[1], high_corner[2]));
  const Vector3d edge = edge_of(problem, body), low(own.origin[0], own.origin[1], own.origin[2]);
  PassedCells passed(grid_size(problem.lattice, body));
  for (const std::uint32_t t : triangles) {
    std::array<Vector3d, 3> corners = surface->corners_of(t);
    for (Vector3d& corner : corners) corner = (corner - low).cwiseQuotient(edge);
    passed.add(corners);
  }
  std::vector<std::size_t> elements;
  problem.lattice.for_each_element([&](std::size_t element, const Row& row, int x) {
    if (row.body == body && passed.has(x, row.y, row.z)) elements.push_back(element);
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
