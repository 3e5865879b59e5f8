/// Bodies from surfaces: STL files, cells inside, and what is reported of them.
#include "solver/error.hpp"
#include "solver/surface/shape_report.hpp"
#include "solver/surface/stl.hpp"
#include "solver/surface/voxelize.hpp"
#include "solver/surface/winding_number.hpp"
#include "tests/fixtures/own_directory.hpp"
#include "tests/fixtures/surfaces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dss {
namespace {

using fixture::Facets;

class Surfaces : public test::OwnDirectory {
protected:
  Surface surface(const Facets& facets, const SurfacePlacement& placement = {}) const {
    return read_stl(written("part.stl", fixture::binary_stl(facets)), placement);
  }
  /// The one line with which a file is refused.
  template <class Read>
  std::string refusal(Read&& read) const {
    try {
      read();
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("part.stl"), std::string::npos) << error.what();
      return error.what();
    }
    ADD_FAILURE() << "accepted";
    return {};
  }
  std::string refused_file(const std::string& bytes) const {
    return refusal([&] { read_stl(written("part.stl", bytes), {}); });
  }
  std::string refused_body(const Facets& facets, double edge,
                           SurfaceRule rule = SurfaceRule::closed) const {
    return refusal([&] {
      const Surface part = surface(facets);
      filled(part, grid_around(part, Eigen::Vector3d::Constant(edge), 1000000), rule);
    });
  }
};

VoxelGrid cells_of(const Surface& part, double edge, SurfaceRule rule = SurfaceRule::closed) {
  return filled(part, grid_around(part, Eigen::Vector3d::Constant(edge), 100000000), rule);
}
std::size_t count_of(const VoxelGrid& grid) {
  return std::size_t(std::ranges::count(grid.occupied, 1));
}
Facets joined(Facets one, const Facets& other) {
  one.insert(one.end(), other.begin(), other.end());
  return one;
}

TEST_F(Surfaces, of_boxes_are_filled_exactly_to_their_faces) {
  const Facets box = fixture::box_facets({1, 2, 3}, {5, 5, 5});
  const Surface part = surface(box);
  EXPECT_EQ(part.corners.size(), 8U);
  EXPECT_NEAR(enclosed_volume(part), 24, 1e-5);
  EXPECT_EQ(unpaired_edges(part), 0U);
  const SpaceGrid grid = grid_around(part, {0.5, 1, 0.25}, 1000000);
  EXPECT_EQ(grid.count, (std::array<int, 3>{8, 3, 8}));
  EXPECT_LT((grid.low - Eigen::Vector3d(1, 2, 3)).norm(), 1e-6);
  EXPECT_EQ(count_of(filled(part, grid, SurfaceRule::closed)), 8U * 3U * 8U);
}

TEST_F(Surfaces, as_text_binary_or_inside_out_are_the_same_body) {
  const Facets sphere = fixture::sphere_facets(1, 12);
  const VoxelGrid binary = cells_of(surface(sphere), 0.1);
  const Surface text = read_stl(written("text.stl", fixture::ascii_stl(sphere)), {});
  EXPECT_EQ(cells_of(text, 0.1).occupied, binary.occupied);
  EXPECT_EQ(cells_of(surface(fixture::reversed(sphere)), 0.1).occupied, binary.occupied);
}

TEST_F(Surfaces, of_spheres_converge_and_are_symmetric) {
  const Surface part = surface(fixture::sphere_facets(1, 64));
  for (const double edge : {0.2, 0.1, 0.05}) {
    const VoxelGrid grid = cells_of(part, edge);
    const double volume = double(count_of(grid)) * edge * edge * edge;
    EXPECT_NEAR(volume / enclosed_volume(part), 1, 0.3 * edge) << edge;
    std::vector<std::uint8_t> mirrored(grid.occupied.rbegin(), grid.occupied.rend());
    EXPECT_EQ(mirrored, grid.occupied) << edge; // through the centre
  }
}

TEST_F(Surfaces, turn_and_are_scaled_as_asked) {
  SurfacePlacement placement;
  placement.unit = length_of_unit("mm");
  placement.set_axes({"+y", "-z", "+x"});
  const Surface part = surface(fixture::box_facets({1, 2, 3}, {2, 4, 6}), placement);
  const auto [low, high] = bounds(part);
  EXPECT_LT((low - Eigen::Vector3d(2e-3, -6e-3, 1e-3)).norm(), 1e-9);
  EXPECT_LT((high - Eigen::Vector3d(4e-3, -3e-3, 2e-3)).norm(), 1e-9);
  EXPECT_NEAR(enclosed_volume(part) / 6e-9, 1, 1e-6); // outer sides still show
  placement.set_axes({"-y", "-z", "+x"});
  EXPECT_GT(enclosed_volume(surface(fixture::box_facets({1, 2, 3}, {2, 4, 6}), placement)), 0);
  EXPECT_THROW(placement.set_axes({"+x", "-x", "+y"}), InputError);
  EXPECT_THROW(placement.set_axes({"+x", "+y"}), InputError);
  EXPECT_THROW(placement.set_axes({"+x", "+y", "z"}), InputError);
  EXPECT_THROW(length_of_unit("furlong"), InputError);
}

TEST_F(Surfaces, with_corners_and_edges_on_the_lines_through_centres_are_filled) {
  // An octahedron with its corners on centres of cells: lines meet edges and corners alone.
  const std::array<Eigen::Vector3f, 6> tips = {
      {{3, 0, 0}, {-3, 0, 0}, {0, 3, 0}, {0, -3, 0}, {0, 0, 3}, {0, 0, -3}}};
  Facets facets;
  for (const std::size_t x : {0U, 1U})
    for (const std::size_t y : {2U, 3U})
      for (const std::size_t z : {4U, 5U}) {
        const bool is_odd = (x + y + z) % 2 != 0;
        facets.push_back(is_odd ? fixture::Facet{tips[x], tips[z], tips[y]}
                                : fixture::Facet{tips[x], tips[y], tips[z]});
      }
  const Surface part = surface(facets);
  EXPECT_EQ(unpaired_edges(part), 0U);
  SpaceGrid grid;
  grid.low = Eigen::Vector3d::Constant(-4.5);
  grid.count = {9, 9, 9};
  const VoxelGrid cells = filled(part, grid, SurfaceRule::closed);
  std::size_t inside = 0, around = 0; // |x| + |y| + |z| < 3 and <= 3
  for (int z = -4; z <= 4; ++z)
    for (int y = -4; y <= 4; ++y)
      for (int x = -4; x <= 4; ++x) {
        const int sum = std::abs(x) + std::abs(y) + std::abs(z);
        inside += sum < 3, around += sum <= 3;
        const std::size_t cell = std::size_t(((z + 4) * 9 + y + 4) * 9 + x + 4);
        EXPECT_TRUE(sum == 3 || cells.occupied[cell] == (sum < 3));
      }
  EXPECT_GE(count_of(cells), inside);
  EXPECT_LE(count_of(cells), around);
}

TEST_F(Surfaces, have_winding_numbers_of_one_inside_and_zero_outside) {
  const Surface part = surface(fixture::sphere_facets(1, 40));
  const WindingNumber number(part);
  for (const double radius : {0.0, 0.5, 0.9, 0.97})
    EXPECT_NEAR(number.at({0.6 * radius, -0.64 * radius, 0.48 * radius}), 1, 0.03) << radius;
  for (const double radius : {1.03, 1.1, 2.0, 10.0})
    EXPECT_NEAR(number.at({0.6 * radius, -0.64 * radius, 0.48 * radius}), 0, 0.03) << radius;
  EXPECT_EQ(cells_of(part, 0.07, SurfaceRule::winding).occupied, cells_of(part, 0.07).occupied);
}

TEST_F(Surfaces, that_are_open_are_closed_by_winding_numbers_alone) {
  Facets sphere = fixture::sphere_facets(1, 24);
  const std::size_t whole = count_of(cells_of(surface(sphere), 0.05));
  sphere.erase(sphere.begin() + 500);
  sphere.erase(sphere.begin() + 100, sphere.begin() + 102);
  const std::string why = refused_body(sphere, 0.05);
  EXPECT_NE(why.find("is open, or shows both sides: 7 of its edges"), std::string::npos) << why;
  const auto cells = double(count_of(cells_of(surface(sphere), 0.05, SurfaceRule::winding)));
  EXPECT_NEAR(cells / double(whole), 1, 2e-3);
}

TEST_F(Surfaces, that_are_wide_open_are_no_bodies) {
  Facets box = fixture::box_facets({0, 0, 0}, {4, 4, 4});
  box.erase(box.begin() + 5); // half of a face
  EXPECT_NE(refused_body(box, 0.1, SurfaceRule::winding).find("does not enclose a body"),
            std::string::npos);
  Facets bowl = fixture::box_facets({0, 0, 0}, {4, 4, 1});
  bowl.resize(10); // without its lid
  EXPECT_NE(refused_body(bowl, 0.1, SurfaceRule::winding).find("does not enclose a body"),
            std::string::npos);
  EXPECT_NE(refused_body(fixture::box_facets({0, 0, 0}, {0, 4, 4}), 0.5, SurfaceRule::winding)
                .find("larger than the part"),
            std::string::npos);
}

TEST_F(Surfaces, that_overlap_are_joined_by_winding_numbers_alone) {
  const Facets two =
      joined(fixture::box_facets({0, 0, 0}, {4, 2, 2}), fixture::box_facets({2, 1, 0}, {6, 3, 2}));
  const std::string why = refused_body(two, 0.5);
  EXPECT_NE(why.find("winding number 2 at [2.25, 1.25, 0.25] m"), std::string::npos) << why;
  EXPECT_EQ(count_of(cells_of(surface(two), 0.5, SurfaceRule::winding)), 8U * (16 + 16 - 4));
  Facets hidden = fixture::reversed(fixture::box_facets({5, 0, 0}, {6, 1, 1})); // inside out
  EXPECT_NE(refused_body(joined(fixture::box_facets({0, 0, 0}, {4, 2, 2}), hidden), 0.5)
                .find("winding number -1"),
            std::string::npos);
}

TEST_F(Surfaces, leave_out_hollows) {
  const Facets shell = joined(fixture::box_facets({0, 0, 0}, {5, 5, 5}),
                              fixture::reversed(fixture::box_facets({1, 1, 1}, {4, 4, 4})));
  EXPECT_EQ(count_of(cells_of(surface(shell), 0.5)), 1000U - 216U);
}

TEST_F(Surfaces, of_parts_that_do_not_fit_their_cells_are_refused) {
  const Facets box = fixture::box_facets({0, 0, 0}, {4, 4, 1});
  EXPECT_NE(refused_body(box, 1.5).find("larger than the part along z; it measures 4 x 4 x 1 m"),
            std::string::npos);
  EXPECT_NE(refused_body(box, 1e-3).find("more than 1000000 cells"), std::string::npos);
  EXPECT_NE(refusal([&] {
              edge_for(surface(fixture::box_facets({0, 0, 0}, {400, 40, 40})), 100);
            }).find("it measures 400 x 40 x 40 m; check the unit"),
            std::string::npos);
  EXPECT_DOUBLE_EQ(edge_for(surface(box), 8), 0.5);
}

TEST_F(Surfaces, in_files_that_are_none_are_refused_in_one_line) {
  const Facets box = fixture::box_facets({0, 0, 0}, {1, 1, 1});
  const std::string binary = fixture::binary_stl(box), text = fixture::ascii_stl(box);
  const auto says = [&](const std::string& bytes, const std::string& part) {
    const std::string why = refused_file(bytes);
    EXPECT_NE(why.find(part), std::string::npos) << why;
  };
  says("", "neither a binary nor an ASCII");
  says("plain text", "neither a binary nor an ASCII");
  says(binary.substr(0, 600), "it has 600 bytes; a binary file of 12 triangles has 684");
  says(binary.substr(0, 84), "a binary file of 12 triangles");
  says(fixture::binary_stl({}), "has no triangle");
  says("solid nothing\nendsolid nothing\n", "has no triangle");
  says(text.substr(0, text.size() / 2), "cut off");
  says(text.substr(0, text.find("outer")), "cut off");
  says(text + text.substr(0, text.size() / 2), "cut off"); // in a second solid
  says("solid x\nfacet vertex 0 0 0 vertex 1 0 0 endfacet endsolid", "facet 0 has 2 vertices");
  says("solid x\nfacet vertex 0 0 zero", "facet 0: \"zero\" is not a number");
  says("solid x\nfacet vertex 0 0", "facet 0: \"\" is not a number");
  Facets infinite = box;
  infinite[7][1].y() = INFINITY;
  says(fixture::binary_stl(infinite), "triangle 7 has a number that is not finite");
  Facets flat(4, {Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(1, 0, 0)});
  says(fixture::binary_stl(flat), "has no triangle");
  EXPECT_THROW(read_stl(directory.string(), {}), InputError);
  EXPECT_THROW(read_stl(file("none.stl"), {}), InputError);
}

TEST_F(Surfaces, may_have_numbers_that_single_precision_rounds_to_zero) {
  std::string text = fixture::ascii_stl(fixture::box_facets({0, 0, 0}, {1, 1, 1}));
  const std::string zero = "0.000000e+00";
  for (std::size_t at = 0; (at = text.find(zero)) != std::string::npos;)
    text.replace(at, zero.size(), "6.1e-50");
  const Surface part = read_stl(written("part.stl", text), {});
  EXPECT_EQ(part.corners.size(), 8U);
  EXPECT_EQ(unpaired_edges(part), 0U);
}

TEST_F(Surfaces, that_are_open_have_no_volume) {
  Facets box = fixture::box_facets({0, 0, 0}, {4, 4, 4});
  box.pop_back();
  const Surface part = surface(box);
  const SpaceGrid grid = grid_around(part, Eigen::Vector3d::Constant(0.5), 1000000);
  VoxelGrid cells{8, 8, 8, std::vector<std::uint8_t>(512, 1)};
  EXPECT_TRUE(std::isnan(report_shape(part, grid, cells).surface_volume));
}

TEST_F(Surfaces, are_reported_with_volume_thinnest_wall_and_pieces) {
  // A box with a wall of 0.3 beside a slot, and a box apart.
  const Facets two = joined(fixture::box_facets({0, 0, 0}, {4, 2, 0.3F}),
                            fixture::box_facets({0, 0, 1}, {4, 2, 3}));
  const Surface part = surface(two);
  const SpaceGrid grid = grid_around(part, Eigen::Vector3d::Constant(0.1), 1000000);
  const ShapeReport report = report_shape(part, grid, filled(part, grid, SurfaceRule::closed));
  EXPECT_NEAR(report.surface_volume, 18.4, 1e-4);
  EXPECT_NEAR(report.volume_error(), 0, 1e-5);
  ASSERT_TRUE(report.thinnest.has_value());
  EXPECT_NEAR(report.thinnest->thickness, 0.3, 1e-6);
  EXPECT_NEAR(report.thinnest->elements, 3, 1e-5);
  EXPECT_NEAR(report.thinnest->place.z(), 0.15, 1e-6);
  EXPECT_EQ(report.pieces, (std::vector<std::size_t>{16000, 2400}));
}

TEST_F(Surfaces, of_parts_that_overlap_are_reported_as_one) {
  const Surface part = surface(
      joined(fixture::box_facets({0, 0, 0}, {4, 2, 2}), fixture::box_facets({2, 1, 0}, {6, 3, 2})));
  const SpaceGrid grid = grid_around(part, Eigen::Vector3d::Constant(0.5), 1000000);
  const ShapeReport report = report_shape(part, grid, filled(part, grid, SurfaceRule::winding));
  EXPECT_NEAR(report.surface_volume, 28, 1e-6);
  ASSERT_TRUE(report.thinnest.has_value());
  EXPECT_NEAR(report.thinnest->thickness, 2, 1e-6); // not 1, where both parts overlap
}

TEST_F(Surfaces, have_walls_measured_across_their_slope) {
  Facets plate = fixture::box_facets({-4, -1, -0.2F}, {4, 1, 0.2F});
  const Eigen::AngleAxisf turn(0.6F, Eigen::Vector3f(0.2F, 1, 0.1F).normalized());
  for (fixture::Facet& facet : plate)
    for (Eigen::Vector3f& corner : facet) corner = turn * corner;
  const Surface part = surface(plate);
  const SpaceGrid grid = grid_around(part, Eigen::Vector3d::Constant(0.1), 1000000);
  const ShapeReport report = report_shape(part, grid, filled(part, grid, SurfaceRule::closed));
  ASSERT_TRUE(report.thinnest.has_value());
  EXPECT_NEAR(report.thinnest->thickness, 0.4, 1e-5);
  EXPECT_NEAR(report.thinnest->elements, 4, 1e-4);
}

} // namespace
} // namespace dss
