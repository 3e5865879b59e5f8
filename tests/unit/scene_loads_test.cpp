/// Loads of scenes: where they act, and series from files.
#include "solver/error.hpp"
#include "solver/io/series_csv.hpp"
#include "solver/scene/scene.hpp"
#include "tests/fixtures/own_directory.hpp"
#include "tests/fixtures/surfaces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace dss {
namespace {

class SceneLoads : public test::OwnDirectory {
protected:
  /// The problem of a bar of 4 x 2 x 1 elements of 2 x 3 x 5 m with these keys.
  Problem with(const std::string& keys) const {
    return load_scene(
               written("bar.json",
                       R"({"scene": "bar", "title": "a bar", "run": {"dt": 1e-3, "steps": 1000},
      "bodies": [{"name": "b", "element": [2, 3, 5], "geometry": {"box": [4, 2, 1]},
                  "constants": {"law": "solid", "E": 1e6, "nu": 0.25, "rho": 1000}}], )" +
                           keys + "}"))
        .problem;
  }
  Problem with_load(const std::string& load) const { return with(R"("loads": [{)" + load + "}]"); }
};

std::string refused(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    return text;
  }
  ADD_FAILURE() << "accepted";
  return {};
}

TEST_F(SceneLoads, tractions_and_pressures_act_in_the_middle_of_faces) {
  const Load traction =
      with_load(R"("select": {"face": "+x"}, "traction": [10, 0, 2])").loads.at(0);
  EXPECT_EQ(traction.elements, (std::vector<std::size_t>{3, 7}));
  EXPECT_EQ(traction.face, 1);
  EXPECT_EQ(traction.force, (Vec3{150, 0, 30}));
  EXPECT_EQ(traction.torque, (Vec3{0, -30, 0})); // (1, 0, 0) m x force
  EXPECT_DOUBLE_EQ(traction.face_strain, 10 / (4 * 4e5));
  const Load pressure = with_load(R"("select": {"face": "-z"}, "pressure": 7)").loads.at(0);
  EXPECT_EQ(pressure.face, 4);
  EXPECT_EQ(pressure.force, (Vec3{0, 0, 42})); // pushes from below
  EXPECT_EQ(pressure.torque, (Vec3{0, 0, 0}));
  EXPECT_DOUBLE_EQ(pressure.face_strain, -7 / (4 * 4e5));
}

TEST_F(SceneLoads, densities_may_depend_on_the_place) {
  const std::vector<Load> loads =
      with_load(R"("select": {"face": "-y"}, "pressure": "=2*x", "signal": 3)").loads;
  ASSERT_EQ(loads.size(), 4u); // centres at x = 1, 3, 5, 7 m, faces of 10 m^2
  for (std::size_t n = 0; n < loads.size(); ++n) {
    EXPECT_EQ(loads[n].elements, std::vector<std::size_t>{n});
    EXPECT_DOUBLE_EQ(loads[n].force[1], 20 * (1 + 2 * double(n)));
    EXPECT_DOUBLE_EQ(loads[n].face_strain, -2 * (1 + 2 * double(n)) / (4 * 4e5));
    EXPECT_EQ(loads[n].signal(0), 3);
  }
  const Load top =
      with_load(R"("select": {"face": "+z"}, "traction": [0, "=z", "=-y"])").loads.at(5);
  EXPECT_EQ(top.force, (Vec3{0, 6 * 5, -6 * 4.5})); // at the middle of the face, (3, 4.5, 5) m
  const Load volume =
      with_load(R"("select": {"all": true}, "body_force": ["=z", 0, 0])").loads.at(0);
  EXPECT_EQ(volume.force, (Vec3{30 * 2.5, 0, 0}));
}

TEST_F(SceneLoads, parameters_hide_the_coordinates_of_a_place) {
  const Problem bar = with(R"("parameters": {"x": 3},
      "loads": [{"select": {"face": "-y"}, "pressure": "=2*x"}])");
  ASSERT_EQ(bar.loads.size(), 1u);
  EXPECT_DOUBLE_EQ(bar.loads[0].force[1], 60);
}

TEST_F(SceneLoads, fields_name_functions_of_the_place) {
  const Problem bar = with(R"("parameters": {"p": 2}, "fields": {"twice": "=p*x"},
      "loads": [{"select": {"face": "-y"}, "pressure": "=twice+1"}])");
  ASSERT_EQ(bar.loads.size(), 4u);
  EXPECT_DOUBLE_EQ(bar.loads[3].force[1], 10 * (2 * 7 + 1));
}

TEST_F(SceneLoads, mistakes_in_densities_of_a_place_have_their_line) {
  EXPECT_NE(refused([&] {
              with_load(R"("select": {"face": "-y"}, "pressure": "=1/(x-3)^2")");
            }).find("/loads/0/pressure: \"=1/(x-3)^2\" is inf"),
            std::string::npos);
  EXPECT_NE(refused([&] {
              with_load(R"("select": {"face": "-y"}, "force": ["=x", 0, 0])");
            }).find("not an expression over the scene's parameters"),
            std::string::npos);
}

/// A body from a surface, with its load.
class SurfaceLoads : public SceneLoads {
protected:
  Problem of(const fixture::Facets& facets, const std::string& load,
             const std::string& more = "") const {
    written("part.stl", fixture::binary_stl(facets));
    return load_scene(written("part.json", R"({"scene": "part", "title": "a part",
      "run": {"dt": 1e-6, "steps": 1},
      "bodies": [{"name": "b", "element": [0.1, 0.08, 0.1], )" +
                                               more + R"("geometry": {"stl": {"file": "part.stl",
                  "unit": "m", "surface": "winding"}},
                  "constants": {"law": "solid", "E": 1e6, "nu": 0.25, "rho": 1000}}],
      "loads": [{"select": {"cad_face": )" + load +
                                               "}]}"))
        .problem;
  }
  /// Force of all loads [N].
  static Vec3 total(const Problem& problem) {
    Vec3 sum{};
    for (const Load& load : problem.loads)
      for (std::size_t a = 0; a < 3; ++a) sum[a] += load.force[a] * double(load.elements.size());
    return sum;
  }
};

TEST_F(SurfaceLoads, a_pressure_on_a_ball_has_its_projection_and_no_net_force) {
  const Problem ball = of(fixture::sphere_facets(1, 24), R"({"near": [0, 0, 1]}}, "pressure": 7)");
  ASSERT_EQ(ball.loads.size(), 6u);
  for (const Load& load : ball.loads) {
    const auto axis = std::size_t(load.face) / 2;
    const double push = load.force[axis] * double(load.elements.size());
    EXPECT_NEAR(push * (load.face % 2 == 1 ? -1 : 1) / (7 * std::numbers::pi), 1, 0.02);
    EXPECT_EQ(load.elements.size(), ball.loads[std::size_t(load.face ^ 1)].elements.size());
  }
}

TEST_F(SurfaceLoads, a_pressure_acts_on_its_face_alone_wherever_the_body_is) {
  const fixture::Facets box = fixture::box_facets({0, 0, 0}, {1, 0.8F, 0.5F});
  struct MovedBody {
    std::string origin, near;
  };
  for (const auto& [origin, near] :
       {MovedBody{"", "[0.5, 0.8, 0.2]"},
        MovedBody{R"("origin": [3, -5, 1e4], )", "[3.5, -4.2, 10000.2]"}}) {
    const Problem pressed = of(box, R"({"near": )" + near + R"(}}, "pressure": 7)", origin);
    ASSERT_EQ(pressed.loads.size(), 1u) << origin;
    EXPECT_EQ(pressed.loads[0].face, 3);
    EXPECT_EQ(pressed.loads[0].elements.size(), 50u);
    EXPECT_NEAR(total(pressed)[1], -7 * 0.5, 1e-12);
  }
  const Problem water = of(box, R"({"near": [0, 0.4, 0.2]}}, "pressure": "=4.5-9*z")");
  EXPECT_EQ(water.loads.size(), 50u);
  EXPECT_NEAR(total(water)[0], 9 * 0.5 * 0.5 / 2 * 0.8, 1e-12);
}

TEST_F(SurfaceLoads, a_hole_in_a_surface_takes_no_pressure_from_the_other_side) {
  fixture::Facets ball = fixture::sphere_facets(1, 24);
  const std::string load = R"({"near": [0, 0, 1]}}, "pressure": 7)";
  const Problem closed = of(ball, load);
  const auto at_bottom = [](const fixture::Facet& facet) {
    return std::ranges::all_of(facet, [](const Eigen::Vector3f& p) { return p.z() < -0.9F; });
  };
  ball.erase(std::ranges::find_if(ball, at_bottom));
  const Problem open = of(ball, load);
  ASSERT_EQ(open.loads.size(), 6u);
  EXPECT_EQ(open.loads[5].elements, closed.loads[5].elements);
}

TEST_F(SurfaceLoads, parts_that_overlap_are_pressed_on_their_outer_walls) {
  fixture::Facets both = fixture::box_facets({0, 0, 0}, {1, 0.8F, 0.5F});
  const fixture::Facets plate = fixture::box_facets({0, 0.4F, 0}, {1, 0.84F, 0.5F}); // half a cell
  both.insert(both.end(), plate.begin(), plate.end());
  // The wall of the box at y = 0.8 lies in the plate, within a cell of the plate's own.
  EXPECT_NEAR(total(of(both, R"({"near": [0.5, 0.84, 0.2]}}, "pressure": 7)"))[1], -7 * 0.5, 1e-12);
}

TEST_F(SceneLoads, body_forces_act_on_volumes) {
  const Load load = with_load(R"("select": {"face": "+x"}, "body_force": [0, 0, -2])").loads.at(0);
  EXPECT_EQ(load.force, (Vec3{0, 0, -60}));
  EXPECT_EQ(load.face, -1);
  EXPECT_EQ(load.face_strain, 0);
}

TEST_F(SceneLoads, a_force_at_a_point_has_its_moment_about_the_middle_of_its_element) {
  const Load load =
      with_load(R"("at": [8, 4, 5], "force": [0, 0, 6], "torque": [1, 2, 3])").loads.at(0);
  EXPECT_EQ(load.elements, (std::vector<std::size_t>{7})); // its middle is (7, 4.5, 2.5)
  EXPECT_EQ(load.force, (Vec3{0, 0, 6}));
  EXPECT_EQ(load.torque, (Vec3{1 - 3, 2 - 6, 3})); // (1, -0.5, 2.5) m x force
  EXPECT_EQ(load.face, -1);
}

TEST_F(SceneLoads, a_line_has_its_force_and_its_moment_whole) {
  const Problem bar = with_load(
      R"("line": {"from": [1, 1, 5], "to": [7, 4, 5]}, "force": [0, 2, -9], "signal": 3)");
  EXPECT_EQ(bar.loads.size(), 5u); // it crosses from y = 0 to y = 1 inside of an element in x
  Vec3 force{}, moment{};
  std::vector<Vec3> centres(8);
  bar.lattice.for_each_element(
      [&](std::size_t e, const Row& row, int x) { centres[e] = rest_position(bar, row, x); });
  for (const Load& load : bar.loads) {
    const Vec3 &c = centres[load.elements.at(0)], &f = load.force;
    for (std::size_t a = 0; a < 3; ++a) force[a] += f[a], moment[a] += load.torque[a];
    moment[0] += c[1] * f[2] - c[2] * f[1];
    moment[1] += c[2] * f[0] - c[0] * f[2];
    EXPECT_EQ(load.signal(0), 3);
  }
  EXPECT_NEAR(force[1], 2, 1e-12);
  EXPECT_NEAR(force[2], -9, 1e-12);
  EXPECT_NEAR(moment[0], 2.5 * -9 - 5 * 2, 1e-11); // of the force in the middle (4, 2.5, 5)
  EXPECT_NEAR(moment[1], 4 * 9, 1e-11);
}

TEST_F(SceneLoads, a_line_between_elements_is_shared_by_them) {
  const Problem bar =
      with_load(R"("line": {"from": [0, 3, 1], "to": [8, 3, 1]}, "force": [8, 0, 0])");
  EXPECT_EQ(bar.loads.size(), 8u);
  for (const Load& load : bar.loads) EXPECT_DOUBLE_EQ(load.force[0], 1);
}

TEST_F(SceneLoads, a_line_is_spread_evenly_where_some_of_it_is_between_elements) {
  const std::string path = written("step.json", R"({"scene": "step", "title": "a step",
      "run": {"dt": 1, "steps": 1},
      "bodies": [{"name": "b", "element": 0.1, "origin": [0, -0.03, 0],
                  "geometry": {"voxels": {"layers": [["####", "##.."]]}},
                  "constants": {"law": "paper"}}],
      "loads": [{"line": {"from": [0, 0.07, 0], "to": [0.4, 0.07, 0]}, "force": [0, 0, 8]}]})");
  const Problem step = load_scene(path).problem;
  double moment = 0, force = 0; // about y, of forces at the middles of elements and their arms
  for (const Load& load : step.loads) {
    const double x = 0.05 + 0.1 * double(load.elements[0] % 4);
    force += load.force[2];
    moment += x * load.force[2] - load.torque[1];
  }
  EXPECT_EQ(step.loads.size(), 6u);
  EXPECT_NEAR(force, 8, 1e-12);
  EXPECT_NEAR(moment, 8 * 0.2, 1e-5);
}

TEST_F(SceneLoads, a_line_beyond_the_body_is_refused_wherever_it_is) {
  const std::string why = refused(
      [&] { with_load(R"("line": {"from": [0, 3, 1], "to": [16, 3, 1]}, "force": [8, 0, 0])"); });
  EXPECT_NE(why.find("over 50 % of its length"), std::string::npos) << why;
}

TEST_F(SceneLoads, a_series_is_a_column_of_a_file) {
  written("road.csv", "# a road\nt [s], ax [m/s^2], az [m/s^2]\n0,1,2\n\n0.5,3,4\r\n1,5,-6\n");
  const Problem bar = with(R"("base_acceleration": {"z": {"series":
      {"file": "road.csv", "column": "az", "factor": 2}, "offset": 1}})");
  const Signal& felt = bar.frame_acceleration[2];
  EXPECT_DOUBLE_EQ(felt(0), -(2 * 2 + 1));
  EXPECT_DOUBLE_EQ(felt(0.25), -(2 * 3 + 1));
  EXPECT_DOUBLE_EQ(felt(1), -(2 * -6 + 1));
  EXPECT_EQ(why_series_too_short(bar, 1), "");
  EXPECT_NE(why_series_too_short(bar, 1.5).find("road.csv ends at 1 s, the run at 1.5 s"),
            std::string::npos);
  const Problem held = with(R"("base_acceleration": {"z": {"series":
      {"file": "road.csv", "column": "az", "hold": true}}})");
  EXPECT_EQ(why_series_too_short(held, 1.5), "");
  const std::string before = series_digest(bar);
  written("road.csv", "t [s],az [m/s^2]\n0,2\n0.5,4\n1,-6.5\n");
  EXPECT_NE(series_digest(with(R"("base_acceleration": {"z": {"series":
      {"file": "road.csv", "column": "az"}}})")),
            before);
}

TEST_F(SceneLoads, a_series_of_angles_is_smooth_and_lasts_as_long_as_the_run) {
  written("turn.csv", "t [s],az [rad]\n0,0\n0.1,0.02\n0.2,0.03\n0.3,0.01\n");
  const auto turning = [&](const std::string& more) {
    return with(R"("base_rotation": {"z": {"series": {"file": "turn.csv", "column": "az")" + more +
                "}}}");
  };
  const Problem bar = turning("");
  EXPECT_EQ(bar.frame_rotation[2].kind, Signal::Kind::spline);
  EXPECT_DOUBLE_EQ(bar.frame_rotation[2](0.2), 0.03);
  EXPECT_EQ(why_series_too_short(bar, 0.3), "");
  EXPECT_NE(why_series_too_short(bar, 0.4), "");
  const std::string why = refused([&] { turning(R"(, "hold": true)"); });
  EXPECT_NE(why.find("would stop in no time"), std::string::npos) << why;
  const std::string before = series_digest(bar);
  written("turn.csv", "t [s],az [rad]\n0,0\n0.1,0.02\n0.2,0.031\n0.3,0.01\n");
  EXPECT_NE(series_digest(turning("")), before);
}

TEST_F(SceneLoads, a_bad_series_is_refused_with_its_line) {
  const auto says = [&](const std::string& text, const std::string& part) {
    const std::string path = written("bad.csv", text);
    const std::string why = refused([&] { read_series(path, "a"); });
    EXPECT_NE(why.find("bad.csv"), std::string::npos) << why;
    EXPECT_NE(why.find(part), std::string::npos) << why;
  };
  says("", "is empty");
  says("t [s],a [N]\n", "has no values");
  says("t,a\n0,1\n", "line 1: the first column is \"t\"; it must be the time, with its unit");
  says("t [ms],a\n0,1\n", "must be the time");
  says("t [s],a [m],a [mm]\n0,1,2\n", "line 1: two columns are named \"a\"");
  says("t [s],b\n0,1\n", "line 1: there is no column \"a\"; did you mean \"b\"?");
  says("t [s],a\n0,1\n1\n", "line 3: has 1 values; the header has 2");
  says("t [s],a\n0,1\n1,\n", "line 3: has no value of \"a\"");
  says("t [s],a\n0,1\n1,x\n", "line 3: \"x\" of column \"a\" is no number");
  says("t [s],a\n0,1\n1,nan\n", "no number");
  says("t [s],a\n0,1\n0,2\n", "line 3: 0 s is not after 0 s; times ascend");
  says("t [s],a\n0,1\n1,1\n2,1\n3,1\n40,1\n", "gap from 3 to 40 s, 37 times the usual interval");
  EXPECT_NE(refused([&] { read_series((directory / "none.csv").string(), "a"); }).find("be read"),
            std::string::npos);
  EXPECT_NE(refused([&] { read_series(directory.string(), "a"); }).find("be read"),
            std::string::npos);
}

TEST_F(SceneLoads, a_series_may_have_marks_of_other_programs) {
  const std::string path =
      written("excel.csv", "\xEF\xBB\xBF\"t [s]\",\"a [N]\"\r\n0,+1.5\r\n1,2\r\n");
  const Series series = read_series(path, "a");
  EXPECT_EQ(series.values, (std::vector<double>{1.5, 2}));
  EXPECT_EQ(series.unit, "N");
}

TEST_F(SceneLoads, a_series_of_another_unit_or_a_late_start_is_refused) {
  written("late.csv", "t [s],az [m/s^2],u [m]\n0.5,1,2\n1,2,3\n");
  const auto why = [&](const std::string& column) {
    return refused([&] {
      with(R"("base_acceleration": {"z": {"series": {"file": "late.csv", "column": ")" + column +
           "\"}}}");
    });
  };
  EXPECT_NE(why("u").find("has the unit [m]; it must be [m/s^2]"), std::string::npos) << why("u");
  EXPECT_NE(why("az").find("begins at 0.5 s; a run begins at 0 s"), std::string::npos) << why("az");
}

} // namespace
} // namespace dss
