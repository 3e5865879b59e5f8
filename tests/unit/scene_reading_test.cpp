#include "solver/error.hpp"
#include "solver/scene/scene.hpp"
#include "tests/fixtures/own_directory.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace dss {
namespace {

/// The error of load_scene. The test fails if there is none, or if it has more than one line.
std::string refusal(const std::string& scene, const std::vector<Override>& overrides = {}) {
  try {
    load_scene(scene, overrides);
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "accepted";
  return {};
}

void expect_part(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "in: " << text;
}

class scene_file : public test::OwnDirectory {
protected:
  /// A scene of one body with this geometry.
  std::string scene_with(const std::string& geometry) const {
    return written("shape.json",
                   R"({"scene": "shape", "title": "a shape", "run": {"dt": 1e-6, "steps": 1},
      "bodies": [{"name": "b", "element": 1, "constants": {"law": "paper"}, "geometry": )" +
                       geometry + "}]}");
  }
};

TEST(scene_solid, takes_one_isotropic_material_without_lateral_contraction) {
  const std::string constants = "bodies/0/constants/";
  expect_part(refusal("ribbed_plate", {{constants + "nu", "0.3"}}), "exclude each other");
  expect_part(refusal("ribbed_plate", {{constants + "nu", "0"}}), "exclude each other");
  expect_part(refusal("two_bodies", {{"bodies/1/constants/law", "solid"}}),
              "the same along every axis");
}

TEST_F(scene_file, that_is_missing_is_refused_with_the_nearest_name) {
  expect_part(refusal("plate_papr"), "did you mean \"plate_paper\"?");
  expect_part(refusal("quite_another"), "known: block, cantilever_beam");
  expect_part(refusal(""), "no such scene");
  expect_part(refusal((directory / "absent.json").string()), "no such scene file");
  expect_part(refusal(directory.string() + "/"), "is a directory");
}

TEST_F(scene_file, that_is_broken_json_is_refused_with_line_and_column) {
  expect_part(refusal(written("broken.json", "{\n  \"scene\": \"a\",\n  \"title\" \"b\"\n}\n")),
              "line 3, column 13");
  expect_part(refusal(written("cut.json", "{\"scene\": [1, 2")), "line 1, column 16");
  expect_part(refusal(written("empty.json", "")), "empty");
  expect_part(refusal(written("nan.json", "{\"scene\": NaN}")), "not JSON");
  expect_part(refusal(written("huge.json", "{\"scene\": 1e999}")), "number overflow");
  expect_part(refusal(written("bytes.json", "{\"scene\": \"\xff\xfe\"}")), "not JSON");
  expect_part(refusal(written("array.json", "[1]")), "a scene is a JSON object");
}

TEST_F(scene_file, that_says_a_key_twice_is_refused) {
  expect_part(refusal(written("twice.json", R"({"scene": "a", "run": {"dt": 1, "dt": 2}})")),
              ": /run/dt: key \"dt\" stands twice");
}

TEST_F(scene_file, may_name_a_voxel_file_beside_it) {
  written("mask.txt", "##.\n#..\n\n###\n...\n");
  const Scene scene = load_scene(scene_with(R"({"voxels": {"file": "mask.txt"}})"));
  EXPECT_EQ(scene.problem.lattice.element_count, 6U);
  EXPECT_EQ(scene.problem.link_count(), 2U + 2 + 2);
}

TEST_F(scene_file, selects_elements_of_rows_with_holes_by_their_cells) {
  const std::string bodies =
      R"({"scene": "holes", "title": "t", "run": {"dt": 1e-6, "steps": 1}, "bodies": [{"name": "b",
      "element": 1, "constants": {"law": "paper"},
      "geometry": {"voxels": {"layers": [["#.##", "####"]]}}}],
       "clamps": )";
  const auto clamped = [&](const std::string& select) {
    std::vector<std::size_t> elements;
    for (const Clamp& clamp :
         load_scene(written("holes.json", bodies + "[{\"select\": " + select + "}]}"))
             .problem.clamps)
      elements.push_back(clamp.element);
    return elements;
  };
  using Elements = std::vector<std::size_t>;
  EXPECT_EQ(clamped(R"({"box": {"x": [1, 2]}})"), (Elements{1, 4, 5}));
  EXPECT_EQ(clamped(R"({"box": {"x": 3, "y": 0}})"), Elements{2});
  EXPECT_EQ(clamped(R"({"face": "+x"})"), (Elements{2, 6}));
  EXPECT_EQ(clamped(R"({"elements": [[2, 0, 0], [0, 1, 0]]})"), (Elements{1, 3}));
  EXPECT_EQ(clamped(R"({"all": true})"), (Elements{0, 1, 2, 3, 4, 5, 6}));
}

TEST_F(scene_file, with_a_bad_voxel_mask_is_refused) {
  expect_part(refusal(scene_with(R"({"voxels": {"file": "absent.txt"}})")),
              "absent.txt cannot be read");
  written("mask.txt", "##.\n#.\n");
  expect_part(refusal(scene_with(R"({"voxels": {"file": "mask.txt"}})")),
              "layer 0, line 1 has 2 characters");
  written("mask.txt", "##x\n");
  expect_part(refusal(scene_with(R"({"voxels": {"file": "mask.txt"}})")), "write # for an element");
  written("mask.txt", "\n\n");
  expect_part(refusal(scene_with(R"({"voxels": {"file": "mask.txt"}})")), "mask is empty");
  expect_part(refusal(scene_with(R"({"voxels": {"layers": [["..", ".."]]}})")), "no element");
  // A device may have no end.
  expect_part(refusal(scene_with(R"({"voxels": {"file": "/dev/zero"}})")),
              "/dev/zero cannot be read");
}

TEST_F(scene_file, with_lines_of_unequal_lengths_is_refused_before_the_grid_takes_memory) {
  std::string mask(60000, '#');
  for (int line = 1; line < 60000; ++line) mask.append("\n#");
  written("mask.txt", mask);
  expect_part(refusal(scene_with(R"({"voxels": {"file": "mask.txt"}})")),
              "layer 0, line 1 has 1 characters");
}

TEST_F(scene_file, makes_a_porous_box_from_its_seed) {
  const auto lattice = [&](const std::string& more) {
    return load_scene(scene_with(R"({"porous": {"size": [20, 30, 40], )" + more + "}}"))
        .problem.lattice;
  };
  const Lattice first = lattice(R"("filling": 0.6)");
  EXPECT_NEAR(double(first.element_count), 0.6 * 24000, 300); // four standard deviations
  EXPECT_EQ(first.present, lattice(R"("filling": 0.6, "seed": 1)").present);
  EXPECT_NE(first.present, lattice(R"("filling": 0.6, "seed": 2)").present);
  EXPECT_EQ(lattice(R"("filling": 1)").element_count, 24000U);
}

TEST_F(scene_file, makes_struts_along_the_edges_of_cubes) {
  const Scene scene =
      load_scene(scene_with(R"({"struts": {"size": [9, 9, 9], "cell": 6, "thickness": 3}})"));
  // Eight nodes, and twelve struts between two of them.
  EXPECT_EQ(scene.problem.lattice.element_count, 8U * 27 + 12U * 27);
}

TEST_F(scene_file, of_a_union_of_boxes_counts_shared_cells_once) {
  const Scene scene = load_scene(scene_with(
      R"({"boxes": [{"from": [0, 0, 0], "size": [3, 2, 1]},
                     {"from": [2, 0, 0], "size": [2, 3, 1]}]})"));
  EXPECT_EQ(scene.problem.lattice.element_count, 6U + 6 - 2);
}

TEST_F(scene_file, with_more_cells_than_any_run_could_hold_is_refused) {
  expect_part(refusal(scene_with(R"({"box": [2147483647, 2147483647, 2147483647]})")), "too many");
  expect_part(refusal(scene_with(R"({"box": [65536, 32768, 1]})")), "at most 2147483647");
  expect_part(refusal(scene_with(R"({"box": [2147483648, 1, 1]})")), "out of range");
}

TEST_F(scene_file, tells_bounds_of_its_size_without_being_built) {
  const auto bounds = [&](const std::string& geometry) {
    const std::string path = scene_with(geometry);
    const ShapeSize size = scene_size(path);
    const double elements = double(load_scene(path).problem.lattice.element_count);
    EXPECT_LE(size.least_elements, elements) << geometry;
    EXPECT_GE(size.cells, elements) << geometry;
    return std::pair(size.least_elements, size.cells);
  };
  EXPECT_EQ(bounds(R"({"box": [3, 4, 5]})"), std::pair(60.0, 60.0));
  EXPECT_EQ(bounds(R"({"boxes": [{"from": [0, 0, 0], "size": [3, 2, 1]},
                                 {"from": [2, 0, 0], "size": [2, 4, 1]}]})"),
            std::pair(8.0, 16.0));
  EXPECT_EQ(bounds(R"({"voxels": {"layers": [["#.", "##"]]}})"), std::pair(3.0, 4.0));
  EXPECT_EQ(bounds(R"({"porous": {"size": [5, 5, 5], "filling": 0.5}})").second, 125);
  EXPECT_EQ(bounds(R"({"struts": {"size": [9, 9, 9], "cell": 6, "thickness": 3}})").second, 729);
}

TEST(scene_overrides, change_parameters_and_any_scalar) {
  const Scene scene = load_scene(
      "plate_paper", {{"n", "12"}, {"run.dt", "2e-7"}, {"bodies/0/constants/k", "=1e9*n"}});
  EXPECT_EQ(scene.parameters.at("n"), 12);
  EXPECT_EQ(scene.problem.lattice.element_count, 144U);
  EXPECT_EQ(scene.problem.dt, 2e-7);
  EXPECT_EQ(scene.problem.bodies[0].axis[0].k_normal, 12e9);
  EXPECT_EQ(load_scene("plate_paper", {{"loads.0.force.1", "5"}, {"loads.0.share", "each"}})
                .problem.loads[0]
                .force,
            (Vec3{1000, 5, 0}));
}

TEST(scene_overrides, may_set_what_the_file_leaves_at_its_default) {
  const Scene scene =
      load_scene("chain", {{"run.integrator", "velocity_verlet"}, {"stabilization.k", "3"}});
  EXPECT_EQ(scene.integrator, "velocity_verlet");
  EXPECT_EQ(scene.problem.stabilization.k, 3);
}

TEST(scene_overrides, that_name_nothing_are_refused_with_what_there_is) {
  expect_part(refusal("block", {{"nq", "3"}}), "no parameter \"nq\"; did you mean \"nx\"?");
  expect_part(refusal("l_bracket", {{"n", "3"}}), "no parameter \"n\"; it has none");
  expect_part(refusal("block", {{"rnu.dt", "1"}}), "did you mean \"run\"?");
  expect_part(refusal("block", {{"run.stepz", "1"}}), "did you mean \"steps\"?");
  expect_part(refusal("block", {{"run.stepz", "1"}}), "(from --set run.stepz=1)");
  expect_part(refusal("block", {{"bodies/3/name", "a"}}), "items 0 to 0");
  expect_part(refusal("block", {{"run.dt.x", "1"}}), "single value");
  expect_part(refusal("block", {{"run", "1"}}), "not a scalar");
  expect_part(refusal("block", {{"nx", "[1]"}}), "must be a number, a text");
}

TEST(scene_overrides, with_bad_values_are_refused_and_named) {
  expect_part(refusal("plate_paper", {{"n", "-4"}}),
              "/bodies/0/geometry/box/0: -4 (\"=n\") is out of range");
  expect_part(refusal("plate_paper", {{"n", "2.5"}}), "2.5 (\"=n\") is not a whole number");
  expect_part(refusal("plate_paper", {{"n", "many"}}), "(from --set n=many)");
  expect_part(refusal("plate_paper", {{"run.dt", "0"}}), "0 is not positive");
  expect_part(refusal("plate_paper", {{"run.integrator", "rk5"}}),
              "unknown integrator \"rk5\"; did you mean \"rk4\"? known: rk4, velocity_verlet");
  expect_part(refusal("plate_paper", {{"n", "=1/0"}}), "not a finite number");
  expect_part(refusal("plate_paper", {{"n", "=2*m"}}), "\"m\"");
}

TEST(scene_directory, is_that_of_the_environment_if_it_names_one) {
  const std::string before = scene_directory();
  ASSERT_EQ(setenv("DSSBENCH_SCENES", "no/such/place", 1), 0);
  EXPECT_EQ(scene_directory(), "no/such/place");
  expect_part(refusal("block"), "set DSSBENCH_SCENES");
  EXPECT_THROW(list_scenes(), InputError);
  unsetenv("DSSBENCH_SCENES");
  EXPECT_EQ(scene_directory(), before);
}

} // namespace
} // namespace dss
