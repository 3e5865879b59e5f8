#include "solver/scene/cad_face.hpp"

#include "solver/surface/crossings.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace dss {
namespace {

using Eigen::Vector3d;

Vector3d vector_of(const Vec3& v) { return {v[0], v[1], v[2]}; }

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

/// The triangles of the face that a scene names.
std::vector<std::uint32_t> read_triangles(const Node& node, const Body& body,
                                          const std::optional<Surface>& surface) {
  if (!surface)
    node.fail(
        fmt::format("body \"{}\" has no CAD surface; its \"geometry\" is not \"stl\"", body.name));
  ObjectNode face(node);
  const Node near = face.require("near");
  const auto angle_node = face.find("angle");
  const double angle = angle_node ? angle_node->positive() : 30;
  if (angle >= 180) angle_node->fail(fmt::format("{:g} is out of range; 0 < angle < 180", angle));
  face.finish();
  double distance = 0;
  std::vector<std::uint32_t> triangles =
      face_next_to(*surface, vector_of(near.vector()), angle, distance);
  const auto [low, high] = bounds(*surface);
  constexpr double nearest = 0.1; // of the diagonal
  if (distance > nearest * (high - low).norm())
    near.fail(fmt::format(
        "is {:.3g} m from the surface of body \"{}\", which reaches from [{:.4g}, {:.4g}, {:.4g}] "
        "to [{:.4g}, {:.4g}, {:.4g}] m; give a point next to a face",
        distance, body.name, low[0], low[1], low[2], high[0], high[1], high[2]));
  return triangles;
}

/// Whether a line leaves the body through a face between the centre of a cell and that of the next
/// one. It leaves at the crossing up to which outer sides exceed inner ones by most: the outermost
/// wall of parts that overlap, not a fin behind a gap. Of walls at one place, any may be of the
/// face.
/// @param line  crossings, ascending
/// @param side  -1: towards the cell before, 1: towards the one behind
bool leaves_through(const std::vector<bool>& is_of_face, const std::vector<Crossing>& line,
                    int axis, double centre, double edge, int side) {
  constexpr double slack = 1e-3; // of an edge, for rounding
  double exit = 0;
  int passed = 0, most = 0;
  const auto distance = [&](const Crossing& crossing) { return side * (crossing.at - centre); };
  const auto is_outer = [&](const Crossing& crossing) { return side * crossing.normal[axis] > 0; };
  const auto visit = [&](const Crossing& crossing) {
    if (distance(crossing) < -slack * edge || distance(crossing) > (1 + slack) * edge) return;
    passed += is_outer(crossing) ? 1 : -1;
    if (passed > most) most = passed, exit = distance(crossing);
  };
  if (side > 0)
    std::ranges::for_each(line, visit);
  else
    std::for_each(line.rbegin(), line.rend(), visit);
  return most > 0 && std::ranges::any_of(line, [&](const Crossing& crossing) {
           return is_outer(crossing) && is_of_face[crossing.triangle] &&
                  std::abs(distance(crossing) - exit) <= slack * edge;
         });
}

/// Whether a body has a cell beside an element. @param side  -1 or 1, along the axis
bool has_neighbour(const Lattice& lattice, const Row& row, int x, int axis, int side) {
  if (axis == 0) return lattice.is_present(row, x + side);
  const int beside = side < 0 ? row.lower(axis) : row.upper(axis);
  return beside >= 0 && lattice.is_present(lattice.rows[std::size_t(beside)], x);
}

} // namespace

std::vector<std::size_t> read_cad_face(const Node& node, const Problem& problem, int body,
                                       const std::optional<Surface>& surface) {
  const Body& own = problem.bodies[std::size_t(body)];
  const std::vector<std::uint32_t> triangles = read_triangles(node, own, surface);
  const Vector3d edge = vector_of(own.edge), low = vector_of(own.origin);
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

std::array<std::vector<std::size_t>, 6> read_cad_sides(const Node& node, const Problem& problem,
                                                       int body,
                                                       const std::optional<Surface>& surface) {
  const Body& own = problem.bodies[std::size_t(body)];
  std::vector<bool> is_of_face(surface ? surface->triangles.size() : 0);
  for (const std::uint32_t t : read_triangles(node, own, surface)) is_of_face[t] = true;
  const SpaceGrid grid{vector_of(own.origin), vector_of(own.edge),
                       grid_size(problem.lattice, body)};
  std::array<std::vector<std::size_t>, 6> sides;
  for (int axis = 0; axis < 3; ++axis) {
    const Crossings crossings(*surface, grid, axis);
    const auto [u, v] = Crossings::across(axis);
    problem.lattice.for_each_element([&, u = u, v = v](std::size_t element, const Row& row, int x) {
      if (row.body != body) return;
      const std::array<int, 3> cell = {x, row.y, row.z};
      for (const int side : {-1, 1}) {
        if (has_neighbour(problem.lattice, row, x, axis, side)) continue;
        const auto& line = crossings.of_line(cell[std::size_t(u)], cell[std::size_t(v)]);
        if (leaves_through(is_of_face, line, axis, grid.centre(axis, cell[std::size_t(axis)]),
                           grid.edge[axis], side))
          sides[std::size_t(2 * axis + (side > 0))].push_back(element);
      }
    });
  }
  return sides;
}

} // namespace dss
