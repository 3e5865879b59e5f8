/// Solutions, errors against them, and the tables of work against precision.
#include "experiments/run/state/accuracy.hpp"
#include "experiments/run/state/refinement.hpp"
#include "experiments/run/state/run_states.hpp"
#include "experiments/run/state/solution.hpp"
#include "experiments/studies/work_precision/precision_table.hpp"
#include "solver/error.hpp"
#include "solver/io/atomic_file.hpp"
#include "solver/model/energy.hpp"
#include "tests/fixtures/own_directory.hpp"
#include "tests/fixtures/problems.hpp"
#include "tests/runner/measured_cells.hpp"

#include <cmath>
#include <fstream>
#include <gtest/gtest.h>

namespace dss {
namespace {

TEST(SavedTimes, StepsAreWholeAndNoneIsLongerThanAskedFor) {
  const SavedTimes times{2e-3, 10};
  EXPECT_EQ(times.steps_between(1e-6), 200);
  EXPECT_EQ(times.steps_between(1.01e-6), 199);
  EXPECT_EQ(times.steps_between(1), 1);
  EXPECT_EQ(times.whole_steps_between(1e-6), 200);
  EXPECT_THROW(times.whole_steps_between(1.01e-6), InputError);
  EXPECT_THROW(times.whole_steps_between(1), InputError);
}

/// The scene two_elements, which has a closed form.
class Pair : public test::OwnDirectory {
protected:
  Scene scene = load_scene("two_elements", {});
  SavedTimes times{0.1, 5};

  Solution found(double tolerance) const {
    return find_solution(scene.problem, *find_method("rk4"), {"rk4", tolerance, 1e6}, times, {});
  }
  static double exact(double t) {
    const double g = 20 / 2.0, w = std::sqrt(1e4 - g * g);
    return 0.01 * std::exp(-g * t) * (std::cos(w * t) + g / w * std::sin(w * t));
  }
  double largest_error(const std::vector<std::vector<double>>& states) const {
    double most = 0, scale = 0;
    for (std::size_t k = 0; k < states.size(); ++k) {
      const double expected = exact(times.interval() * double(k + 1));
      most = std::max(most, std::abs(states[k][field_count + ux] - expected));
      scale = std::max(scale, std::abs(expected));
    }
    return most / scale;
  }
};

TEST_F(Pair, ASolutionIsAsCloseToTheClosedFormAsItSays) {
  for (const double tolerance : {1e-6, 1e-9, 1e-12}) {
    const Solution solution = found(tolerance);
    EXPECT_LE(solution.error, tolerance);
    EXPECT_GT(solution.error, 0);
    EXPECT_LT(largest_error(solution.states), std::max(3 * solution.error, 1e-14)) << tolerance;
  }
}

TEST_F(Pair, AVariantFindsTheSameSolution) {
  SolutionRule rule{"rk4", 1e-9, 1e6};
  rule.variant = "auto";
  const Solution solution = find_solution(scene.problem, *find_method("rk4"), rule, times, {});
  EXPECT_LE(solution.error, 1e-9);
  EXPECT_LT(largest_error(solution.states), std::max(3 * solution.error, 1e-12));
  EXPECT_NE(rule.key(), SolutionRule({"rk4", 1e-9, 1e6}).key());
}

TEST_F(Pair, ASolutionIsRefusedToAVariantThatDoesNotSuffice) {
  SolutionRule rule{"newmark", 1e-6, 1e6};
  rule.variant = "scalar";
  EXPECT_THROW(find_solution(scene.problem, *find_method("newmark"), rule, times, {}), InputError);
  rule = {"rk4", 1e-6, 1e6, "auto", Model::bending};
  EXPECT_THROW(find_solution(scene.problem, *find_method("rk4"), rule, times, {}), InputError);
}

TEST_F(Pair, ASolutionStopsAtItsMostStepsAndSaysHowFarItCame) {
  const Solution solution =
      find_solution(scene.problem, *find_method("rk4"), {"rk4", 1e-16, 500}, times, {});
  EXPECT_LE(times.end / solution.dt, 500 * 1.001);
  EXPECT_GT(solution.error, 1e-16);
}

TEST_F(Pair, ASolutionIsReadAsItWasWrittenAndACutOneIsRefused) {
  Solution solution = found(1e-6);
  solution.key = "pair of elements";
  write_solution(file("a"), solution);
  const Solution again = read_solution(file("a"));
  EXPECT_EQ(again.key, solution.key);
  EXPECT_EQ(again.states, solution.states);
  EXPECT_EQ(again.times.end, times.end);
  EXPECT_EQ(again.error, solution.error);
  const std::string text = read_text(file("a"));
  std::ofstream(file("cut")) << text.substr(0, text.size() - 3);
  EXPECT_THROW(read_solution(file("cut")), InputError);
  std::ofstream(file("other")) << "dssbench-oracle-1\nx\n3 4\n";
  EXPECT_THROW(read_solution(file("other")), InputError);
}

TEST_F(Pair, ARunIsMeasuredAgainstTheSolutionWhateverItsRepetitions) {
  write_solution(file("a"), found(1e-12));
  RunRequest request;
  request.scene = "two_elements";
  request.variant = "reference";
  request.dt = 1e-3;
  request.reference = file("a");
  const RunResult once = run_scene(request);
  ASSERT_TRUE(once.reference);
  EXPECT_EQ(once.steps, 100);
  EXPECT_EQ(once.runs, 1);
  EXPECT_NEAR(once.reference->accuracy.max / largest_error(run_states(request, times)), 1, 1e-3);
  EXPECT_LE(once.reference->accuracy.final, once.reference->accuracy.max);
  EXPECT_LE(once.reference->accuracy.l2, once.reference->accuracy.max);
  request.repeat_for = 0.02;
  const RunResult repeated = run_scene(request);
  EXPECT_EQ(repeated.status, "ok");
  EXPECT_GT(repeated.runs, 1);
  EXPECT_GE(repeated.sample_s(), 0.02 * (1 - 1e-12));
  EXPECT_EQ(repeated.reference->accuracy.max, once.reference->accuracy.max);
  EXPECT_EQ(repeated.digest, once.digest);
}

TEST_F(Pair, AnAdaptiveRunThatIsRepeatedTakesTheSameSteps) {
  write_solution(file("a"), found(1e-12));
  RunRequest request;
  request.scene = "two_elements";
  request.variant = "reference";
  request.integrator = "dopri5";
  request.dt = 1e-3;
  request.rtol = 1e-5;
  request.reference = file("a");
  const RunResult once = run_scene(request);
  EXPECT_EQ(once.runs, 1);
  EXPECT_LT(once.reference->accuracy.max, 1e-3);
  request.repeat_for = 0.02;
  const RunResult repeated = run_scene(request);
  EXPECT_EQ(repeated.status, "ok");
  EXPECT_GT(repeated.runs, 1);
  EXPECT_EQ(repeated.steps, once.steps);
  EXPECT_EQ(repeated.digest, once.digest);
}

TEST_F(Pair, TheFastestOfSeveralSamplesCounts) {
  RunRequest request;
  request.scene = "two_elements";
  request.steps = 50;
  const RunResult once = run_scene(request);
  EXPECT_EQ(once.samples, 1);
  EXPECT_TRUE(once.balance);
  request.has_balance = false;
  for (const double repeat_for : {0.0, 0.005}) {
    request.samples = 40;
    request.repeat_for = repeat_for;
    const RunResult fastest = run_scene(request);
    EXPECT_EQ(fastest.status, "ok");
    EXPECT_EQ(fastest.samples, 40);
    EXPECT_EQ(fastest.runs > 1, repeat_for > 0);
    EXPECT_GE(fastest.sample_s(), repeat_for * (1 - 1e-12));
    EXPECT_EQ(fastest.digest, once.digest);
    EXPECT_FALSE(fastest.balance);
  }
  request.samples = 0;
  EXPECT_THROW(run_scene(request), InputError);
}

TEST_F(Pair, AStepThatMissesSavedTimesIsRefused) {
  write_solution(file("a"), found(1e-6));
  RunRequest request;
  request.scene = "two_elements";
  request.variant = "reference";
  request.reference = file("a");
  for (const auto& [dt, steps] : {std::pair{1.1e-3, 0L}, std::pair{1e-3, 50L}}) {
    request.dt = dt;
    if (steps > 0) request.steps = steps;
    EXPECT_THROW(run_scene(request), InputError) << dt << " " << steps;
  }
  request.scene = "chain";
  EXPECT_THROW(run_scene(request), InputError);
}

TEST(Accuracy, IsRelativeToTheLargestNumberAtAnySavedTime) {
  const Problem problem = load_scene("two_elements", {}).problem;
  std::vector<std::vector<double>> expected(2, std::vector<double>(2 * field_count, 0.0)),
      actual = expected;
  expected[0][ux] = actual[0][ux] = 4;
  expected[1][ux] = 1;
  actual[1][ux] = 1.2;
  expected[1][field_count + vx] = actual[1][field_count + vx] = 5;
  const Accuracy accuracy = accuracy_of(problem, expected, actual);
  EXPECT_DOUBLE_EQ(accuracy.final, 0.2 / 4);
  EXPECT_DOUBLE_EQ(accuracy.max, 0.2 / 4);
  EXPECT_DOUBLE_EQ(accuracy.l2, 0.2 / 4 / std::sqrt(2.0));
  EXPECT_EQ(accuracy.velocity, 0);
  actual[0][ux] = std::nan("");
  EXPECT_TRUE(std::isinf(accuracy_of(problem, expected, actual).max));
}

TEST(Energy, IsConservedWhereNothingDampsOrLoads) {
  EXPECT_TRUE(conserves_energy(fixture::make_block(2, 2, 2, LinkLaw::material, 0)));
  EXPECT_FALSE(conserves_energy(fixture::make_block(2, 2, 2, LinkLaw::material, 1)));
  Problem tied = fixture::make_block(2, 2, 2, LinkLaw::paper, 0);
  tied.stabilization.d = 1;
  EXPECT_FALSE(conserves_energy(tied));
  EXPECT_FALSE(conserves_energy(
      load_scene("plate_paper",
                 {{"n", "4"}, {"bodies/0/constants/d", "0"}, {"bodies/0/constants/dt", "0"}})
          .problem));
}

TEST(Extrapolation, FindsTheOrderAndTheLimitOfAPowerLaw) {
  std::array<History, 3> grids;
  for (int level = 0; level < 3; ++level) {
    const double h = std::pow(0.5, level);
    grids[std::size_t(level)] = {{1 + 0.1 * std::pow(h, 1.5), 0, 0},
                                 {4 - 0.2 * std::pow(h, 1.5), 0, 0}};
  }
  const Extrapolation limit = extrapolate(grids, 2);
  EXPECT_TRUE(limit.converges);
  EXPECT_NEAR(limit.order, 1.5, 1e-12);
  EXPECT_NEAR(limit.value, 4, 1e-12);
  EXPECT_NEAR(limit.error, 0.2 / 4, 1e-12);
  grids[2][0][0] += 5;
  EXPECT_FALSE(extrapolate(grids, 2).converges);
}

/// A study of measured points, each with an error and a time.
class Points : public ::testing::Test {
protected:
  Points() {
    study.name = "points";
    study.scale.name = "host";
    study.rules = PrecisionRules{
        {}, {1e-2, 1e-6}, {{"plate_paper", "plate", {"rk4", "f32", 0}, {"rk4", "f64", 4e-6}}}};
  }
  /// The variant has a name of its own, so that bits are not compared.
  void add(const std::string& variant, const std::string& precision, long steps, double error,
           double wall_s) {
    Cell point = cell(variant, 1, steps);
    point.dt = 1e-3 / double(steps);
    point.precision = precision;
    study.cells.push_back(point);
    study.accuracy[point.key()] = {{1e-3, 5}, 0};
    for (long repetition = 0; repetition < 6; ++repetition) {
      Record record = row(point, repetition, wall_s * (1 + 1e-3 * double(repetition)));
      record["error_max"] = number_text(error);
      record["reference_error"] = "1e-9";
      records.push_back(record);
    }
  }
  void add_refused(long steps, double step_limit) {
    Cell point = cell("fast", 1, steps);
    point.dt = 1e-3 / double(steps);
    study.cells.push_back(point);
    study.accuracy[point.key()] = {{1e-3, 5}, step_limit};
    Record record = row(point, 0, 1);
    record.erase("wall_s");
    record["status"] = "refused";
    record["reason"] = "above the limit";
    records.push_back(record);
  }
  PrecisionStudy study;
  std::vector<Record> records;
};

TEST_F(Points, TheFrontHasWhatNothingBeatsInBothAndFailedPointsStay) {
  add("fast", "f64", 100, 1e-3, 1);
  add("fast", "f64", 200, 1e-5, 2);
  add("slow", "f64", 100, 1e-3, 3);
  add("fast", "f64", 400, 3e-9, 4);
  add("fast", "f64", 50, 2, 0.5);
  add_refused(10, 1e-6);
  add_refused(20, 1);
  const Table table = precision_table(study, records);
  std::vector<std::string> front, status, below;
  for (const Record& point : table.rows) {
    front.push_back(text_in(point, "pareto"));
    status.push_back(text_in(point, "status"));
    below.push_back(text_in(point, "below_reference"));
  }
  EXPECT_EQ(front, (std::vector<std::string>{"yes", "yes", "no", "yes", "", "", ""}));
  EXPECT_EQ(status,
            (std::vector<std::string>{"ok", "ok", "ok", "ok", "inaccurate", "refused", "failed"}));
  EXPECT_EQ(below, (std::vector<std::string>{"no", "no", "no", "yes", "no", "", ""}));
  EXPECT_EQ(text_in(table.rows[5], "reason"), "above the limit");
  EXPECT_EQ(text_in(table.rows[6], "reason"),
            "refused below its stability limit 1 s: above the limit");
  EXPECT_EQ(number_in(table.rows[0], "evaluations"), 4.0 * 100 * 100);
}

TEST_F(Points, TheCheapestOfAToleranceIsTheFastestThatIsCloseEnough) {
  add("fast", "f64", 100, 1e-3, 1);
  add("fast", "f64", 200, 1e-5, 2);
  const Table cheapest = cheapest_table(study, precision_table(study, records));
  ASSERT_EQ(cheapest.rows.size(), 2u);
  EXPECT_EQ(text_in(cheapest.rows[0], "steps"), "100");
  EXPECT_EQ(text_in(cheapest.rows[1], "status"), "none");
  EXPECT_NE(text_in(cheapest.rows[1], "reason").find("1e-05"), std::string::npos);
}

TEST_F(Points, AComparisonIsOfPointsWithinTheErrorInSpace) {
  add("fast", "f64", 250, 1e-8, 8);
  add("fast", "f64", 100, 1e-5, 4);
  add("fast", "f32", 100, 1e-4, 2);
  add("fast", "f32", 50, 1e-1, 1);
  const Table points = precision_table(study, records);
  Record space = {{"label", "plate"}, {"source", "space"}, {"error", "0.01"}, {"status", "ok"}};
  const Table budget{{"label", "source", "error", "status"}, {space}};
  const Record answer = comparison_table(study, points, records, budget).rows.at(0);
  EXPECT_NEAR(number_in(answer, "times_cheaper"), 4, 1e-9);
  EXPECT_NEAR(number_in(answer, "times_cheaper_than_best_base"), 2, 1e-9);
  space["status"] = "no limit";
  for (const Table& without : {Table{}, Table{budget.columns, {space}}}) {
    const Record none = comparison_table(study, points, records, without).rows.at(0);
    EXPECT_EQ(text_in(none, "status"), "none");
    EXPECT_NE(text_in(none, "reason").find("error_budget"), std::string::npos);
  }
}

} // namespace
} // namespace dss
