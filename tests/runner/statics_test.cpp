#include "experiments/run/statics/settle.hpp"
#include "experiments/studies/statics/statics_study.hpp"
#include "solver/error.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace dss {
namespace {

RunRequest of(const std::string& scene, std::vector<Override> set = {}) {
  RunRequest run;
  run.scene = scene;
  run.overrides = std::move(set);
  return run;
}

AnalysisResult solved(const RunRequest& run, const std::string& solver, double loads = 1,
                      const std::string& masses = "scaled") {
  AnalysisRequest request;
  request.solver = solver;
  request.loads = loads;
  request.masses = masses;
  AnalysisResult result = solve_static(run, request);
  EXPECT_EQ(result.status, "ok") << result.reason;
  return result;
}

const RunRequest beam = of("cantilever_beam", {{"n", "8"}, {"force", "5"}});
const RunRequest bracket = of("l_bracket");
const RunRequest small_plate = of("plate_paper", {{"n", "10"}});

TEST(StaticRun, relaxation_ends_in_newtons_state_at_finite_loads) {
  for (const RunRequest& run : {beam, bracket, small_plate}) {
    const AnalysisResult newton = solved(run, "newton");
    for (const std::string masses : {"scaled", "scene"}) {
      const AnalysisResult relaxed = solved(run, "relaxation", 1, masses);
      EXPECT_LT(displacement_difference(relaxed.state, newton.state), 1e-8)
          << run.scene << " " << masses;
      EXPECT_LT(relaxed.residual, 2e-10); // as computed by the oracle
      EXPECT_NEAR(relaxed.energy_j, newton.energy_j, 1e-8 * newton.energy_j);
    }
  }
}

TEST(StaticRun, three_solutions_agree_where_loads_are_small) {
  for (const RunRequest& run : {beam, bracket, small_plate}) {
    const double loads = run.scene == "plate_paper" ? 1e-3 : 1e-9;
    const std::vector<double> newton = solved(run, "newton", loads).state;
    for (const std::string solver : {"direct", "cg", "relaxation"})
      EXPECT_LT(displacement_difference(solved(run, solver, loads).state, newton), 1e-8)
          << run.scene << " " << solver;
  }
}

TEST(StaticRun, damped_run_settles_to_newtons_state) {
  for (const RunRequest& run : {beam, small_plate}) {
    const AnalysisResult settled = settle(run, {});
    EXPECT_EQ(settled.status, "ok") << settled.reason;
    EXPECT_LT(displacement_difference(settled.state, solved(run, "newton").state), 1e-8)
        << run.scene;
  }
}

TEST(StaticRun, relaxation_runs_in_every_model_and_precision) {
  RunRequest run = small_plate;
  const std::vector<double> newton = solved(run, "newton").state;
  run.model = "planar";
  EXPECT_LT(displacement_difference(solved(run, "relaxation").state, newton), 1e-8);
  EXPECT_LT(displacement_difference(solved(run, "newton").state, newton), 1e-12);
  run.integrator = "rk4";
  EXPECT_LT(displacement_difference(solved(run, "relaxation").state, newton), 1e-8);
  run.precision = "f32";
  const AnalysisResult single = solved(run, "relaxation");
  EXPECT_LT(displacement_difference(single.state, newton), 1e-3);
  EXPECT_NE(single.note.find("stopped falling at"), std::string::npos);
}

TEST(StaticRun, loads_are_those_of_the_end_of_the_run) {
  // The force reaches its value in 0.05 s.
  const auto after = [](const char* steps) {
    return solved(of("cantilever_beam", {{"n", "8"}, {"run.dt", "1e-4"}, {"run.steps", steps}}),
                  "direct");
  };
  EXPECT_NEAR(after("250").max_displacement_m, after("1000").max_displacement_m / 2, 1e-12);
}

TEST(StaticRun, relaxation_that_runs_out_of_steps_says_how_far_it_came) {
  RunRequest run = beam;
  run.steps = 50;
  AnalysisRequest request;
  request.solver = "relaxation";
  const AnalysisResult result = solve_static(run, request);
  EXPECT_EQ(result.status, "not converged");
  EXPECT_NE(result.reason.find("after 50 steps"), std::string::npos) << result.reason;
}

TEST(StaticRun, a_model_that_lacks_loaded_degrees_of_freedom_is_refused) {
  RunRequest run = beam; // loaded across its axis
  run.model = "axial";
  EXPECT_THROW(solve_static(run, {}), InputError);
  run.model = "bending";
  EXPECT_NEAR(solve_static(run, {}).max_displacement_m, solved(beam, "direct").max_displacement_m,
              1e-12);
}

TEST(StaticsStudy, its_rows_hold_every_way_against_newtons) {
  StaticsStudy study;
  study.cases = {{"cantilever_beam", {{"n", "5"}}, 1e-8, true}};
  const Table table = statics_table(study);
  EXPECT_EQ(table.rows.size(), 14u);
  int linear = 0;
  for (const Record& row : table.rows) {
    linear += text_in(row, "status") == "linear";
    EXPECT_NE(text_in(row, "status"), "failed")
        << text_in(row, "solver") << ": " << text_in(row, "reason");
  }
  EXPECT_EQ(linear, 3);
  study.bar = 1e-20;
  EXPECT_EQ(text_in(statics_table(study).rows[4], "status"), "failed");
}

} // namespace
} // namespace dss
