/// Advice: the search for steps, references by halving, and whether the advised run is as accurate
/// as stated.
#include "experiments/run/advise/advise.hpp"
#include "experiments/run/advise/step_search.hpp"
#include "experiments/run/state/accuracy.hpp"
#include "experiments/run/state/solution.hpp"
#include "solver/error.hpp"
#include "solver/scene/scene.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace dss {
namespace {

/// A method whose error is (first / steps)^order above a floor.
StepTask task_of(double order, double first_error, double most_error, double floor = 0) {
  return {10,
          int(order),
          most_error,
          1e9,
          [=](long steps) { return first_error * std::pow(10.0 / double(steps), order) + floor; },
          [](long steps) { return double(steps); }};
}

TEST(StepSearch, FindsTheFewestStepsOfEveryOrder) {
  for (const double order : {1.0, 2.0, 4.0, 5.0})
    for (const double tolerance : {1e-1, 1e-3, 1e-4}) {
      const StepTask task = task_of(order, 1, tolerance);
      const StepResult result = fewest_steps(task);
      const double exact = 10 * std::pow(1 / tolerance, 1 / order);
      ASSERT_EQ(result.verdict, StepResult::Verdict::meets) << order;
      EXPECT_LE(result.error, tolerance);
      EXPECT_GE(double(result.steps), exact * (1 - 1e-9));
      EXPECT_LE(double(result.steps), 1.11 * exact + 2) << order << " " << tolerance;
      EXPECT_EQ(result.error, task.error(result.steps));
    }
}

TEST(StepSearch, TakesTheLargestStepWhereThatMeetsTheTolerance) {
  const StepResult result = fewest_steps(task_of(4, 1e-5, 1e-4));
  EXPECT_EQ(result.steps, 10);
  EXPECT_EQ(result.runs, 1);
}

TEST(StepSearch, SaysThatErrorsStallAtAFloor) {
  const StepResult result = fewest_steps(task_of(4, 1e-3, 1e-6, 1e-5));
  EXPECT_EQ(result.verdict, StepResult::Verdict::stalls);
  EXPECT_LE(result.runs, 6);
}

TEST(StepSearch, StopsWhereStepsCostMoreThanIsOfInterest) {
  StepTask task = task_of(1, 1, 1e-6);
  task.most_cost = 1000;
  const StepResult result = fewest_steps(task);
  EXPECT_EQ(result.verdict, StepResult::Verdict::costs_more);
  EXPECT_LE(result.runs, 3);
  task.most_cost = 9;
  EXPECT_EQ(fewest_steps(task).runs, 0);
}

TEST(StepSearch, GoesPastStepsOfWhichRunsFail) {
  StepTask task = task_of(2, 1, 1e-2);
  const auto error = task.error;
  task.error = [error](long steps) {
    return steps < 35 ? std::numeric_limits<double>::infinity() : error(steps);
  };
  const StepResult result = fewest_steps(task);
  EXPECT_EQ(result.verdict, StepResult::Verdict::meets);
  EXPECT_LE(result.steps, 112);
}

/// A small scene with its solution by the oracle.
struct Known {
  Scene scene;
  SavedTimes times;
  Solution solution;
};
Known known(const std::string& name, const std::vector<Override>& set, double end) {
  Known of{load_scene(name, set), {end, 5}, {}};
  of.solution =
      find_solution(of.scene.problem, *find_method("rk4"), {"rk4", 1e-11, 1e6}, of.times, {});
  return of;
}

void expect_right(const Known& of, Quantity quantity, double tolerance) {
  AdviseRequest request;
  request.tolerance = tolerance;
  request.quantity = quantity;
  request.budget_s = 60;
  const Advice advice = advise(of.scene.problem, of.times, request);
  ASSERT_EQ(advice.failure, "") << of.scene.name << " " << tolerance;
  const Workbench bench(of.scene.problem, of.times, quantity);
  const Observed expected =
      observed_of(of.scene.problem, quantity, of.solution.times, of.solution.states);
  const Observation run = bench.run(advice.chosen.configuration);
  const double error = bench.error(expected, run.observed);
  EXPECT_LE(error, tolerance) << of.scene.name;
  EXPECT_LE(advice.error_estimate, tolerance);
  EXPECT_LE(error, advice.error_estimate + 1e-11) << "an estimate is no bound";
  EXPECT_GE(error, advice.error_estimate - 2 * advice.reference.error - 1e-11);
  ASSERT_TRUE(advice.paper.error);
  const Observation paper = bench.run(advice.paper.configuration);
  EXPECT_NEAR(*advice.paper.error, bench.error(expected, paper.observed),
              advice.reference.error + 1e-11);
}

TEST(Advice, ErrorsAreWithinTheToleranceAndAsEstimated) {
  const Known scenes[] = {known("two_elements", {}, 0.1), known("chain", {{"n", "8"}}, 5e-4),
                          known("cantilever_beam", {{"n", "6"}}, 0.05),
                          known("plate_paper", {{"n", "4"}}, 1e-4)};
  for (const Known& of : scenes)
    for (const double tolerance : {1e-2, 1e-5, 1e-8})
      expect_right(of, Quantity::displacement, tolerance);
}

TEST(Advice, HoldsStressAndEnergyToATolerance) {
  const Known beam = known("cantilever_beam", {{"n", "6"}}, 0.05);
  expect_right(beam, Quantity::stress, 1e-4);
  expect_right(beam, Quantity::energy, 1e-4);
}

TEST(Advice, SaysWhichToleranceIsTheLeastWhereRoundingIsAbove) {
  const Known chain = known("chain", {{"n", "8"}}, 5e-4);
  AdviseRequest request;
  request.tolerance = 1e-18;
  const Advice advice = advise(chain.scene.problem, chain.times, request);
  EXPECT_NE(advice.failure.find("rounding"), std::string::npos) << advice.failure;
  EXPECT_GT(advice.least_tolerance, 1e-18);
  EXPECT_LT(advice.least_tolerance, 1e-9);
  request.tolerance = 2 * advice.least_tolerance;
  EXPECT_EQ(advise(chain.scene.problem, chain.times, request).failure, "");
}

TEST(Advice, RefusesAToleranceThatIsNone) {
  const Scene scene = load_scene("two_elements", {});
  AdviseRequest request;
  request.tolerance = 0;
  EXPECT_THROW(advise(scene.problem, {0.1, 5}, request), InputError);
}

TEST(ObservedError, OfDisplacementsIsThatOfAccuracy) {
  const Known chain = known("chain", {{"n", "8"}}, 5e-4);
  std::vector<std::vector<double>> other = chain.solution.states;
  other[2][3 * field_count + ux] *= 1.001;
  const Observed expected = observed_of(chain.scene.problem, Quantity::displacement,
                                        chain.solution.times, chain.solution.states);
  EXPECT_EQ(observed_error(chain.scene.problem, Quantity::displacement, expected,
                           observed_of(chain.scene.problem, Quantity::displacement,
                                       chain.solution.times, other)),
            accuracy_of(chain.scene.problem, chain.solution.states, other).max);
}

} // namespace
} // namespace dss
