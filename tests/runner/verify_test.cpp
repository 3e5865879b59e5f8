#include "experiments/runner/state_access.hpp"
#include "experiments/runner/verify.hpp"
#include "solver/reference/oracle.hpp"
#include "tests/fixtures/problems.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace dss {
namespace {

/// The oracle behind the interface of variants, with one deliberate fault.
enum class Fault { none, force, lost_element, thread_count };

template <Fault fault>
class FaultyExecutor final : public Executor {
public:
  explicit FaultyExecutor(const Setup& setup)
      : threads_(setup.threads), width_(3 + setup.problem.loads.size()), stages_(std::size_t(setup.method.stages)),
        oracle_(setup.problem, setup.method, setup.dt) {}
  void write(std::size_t first, std::span<const double> fields) override { oracle_.write(fields, first); }
  void read(std::size_t first, std::span<double> fields) override {
    // Whoever does not write an element's fields leaves what was there: the runner puts NaN there.
    oracle_.read(fault == Fault::lost_element ? fields.first(fields.size() - field_count) : fields, first);
    if (fault == Fault::thread_count && threads_ == 3) fields[ux] += 1e-18;
  }
  void derivative(std::span<const double> signals, std::span<double> rates) override {
    oracle_.derivative(signals, rates);
    if (fault == Fault::force) rates[rates.size() - field_count + vx] *= 1 + 1e-9;
  }
  Outcome advance(long steps, std::span<const double> signals) override {
    const auto breakdown = oracle_.advance(steps, [&](long step, int stage) {
      return signals.subspan((std::size_t(step) * stages_ + std::size_t(stage)) * width_, width_);
    });
    return breakdown ? Outcome{false, breakdown->step, breakdown->element} : Outcome{true, steps, 0};
  }
  std::string schedule() const override { return "stage by stage"; }
  std::size_t bytes() const override { return 0; }

private:
  int threads_;
  std::size_t width_, stages_;
  Oracle<double> oracle_;
};

template <Fault fault>
std::unique_ptr<Executor> create(const Setup& setup) {
  return std::make_unique<FaultyExecutor<fault>>(setup);
}

template <Fault fault>
std::vector<VerifyRow> rows_with() {
  Plugin plugin{};
  plugin.abi = plugin_abi;
  plugin.name = "faulty";
  plugin.isa = "none";
  plugin.is_threaded = true;
  plugin.create = create<fault>;
  Scene scene;
  scene.name = "plate";
  scene.problem = fixture::make_plate(5);
  return verify_scene(scene, 20, {&plugin});
}

/// Names of the checks that failed in f64 of the spatial model.
std::vector<std::string> failed_checks(const std::vector<VerifyRow>& rows) {
  std::vector<std::string> names;
  for (const VerifyRow& row : rows)
    if (row.verdict == VerifyRow::Verdict::failed && row.model == "spatial" && row.precision == "f64")
      names.push_back(row.check);
  return names;
}

TEST(Verify, PassesAVariantThatIsRight) {
  const std::vector<VerifyRow> rows = rows_with<Fault::none>();
  EXPECT_TRUE(failed_checks(rows).empty());
  const auto passed =
      std::count_if(rows.begin(), rows.end(), [](const VerifyRow& row) { return row.error && *row.error > 0; });
  EXPECT_GT(passed, 0) << "errors of zero against a longer precision: nothing was compared";
}

TEST(Verify, CatchesAForceThatIsWrongInTheTenthDigit) {
  EXPECT_EQ(failed_checks(rows_with<Fault::force>()), std::vector<std::string>{"evaluation"});
}

TEST(Verify, CatchesAnElementThatIsNeverWritten) {
  const auto failed = failed_checks(rows_with<Fault::lost_element>());
  EXPECT_NE(std::find(failed.begin(), failed.end(), "run rk4"), failed.end());
}

TEST(Verify, CatchesBitsThatDependOnTheThreadCount) {
  const auto failed = failed_checks(rows_with<Fault::thread_count>());
  EXPECT_NE(std::find(failed.begin(), failed.end(), "threads rk4"), failed.end());
}

TEST(Verify, RandomStatesAreUnitRotationsAndRespectClamps) {
  const Problem problem = fixture::make_plate(5);
  const std::vector<double> state = random_state(problem, Model::spatial, Precision::f64, 7);
  double largest_rotation = 0;
  for (std::size_t e = 0; e < state.size(); e += field_count) {
    const double w = 1 + state[e + qs];
    EXPECT_NEAR(w * w + state[e + qx] * state[e + qx] + state[e + qy] * state[e + qy] + state[e + qz] * state[e + qz],
                1, 1e-14);
    largest_rotation = std::max(largest_rotation, 2 * std::acos(std::abs(w)));
  }
  EXPECT_GT(largest_rotation, 1);
  for (int field = vx; field < qs; ++field) EXPECT_EQ(state[std::size_t(field)], 0) << "element 0 is clamped";
}

TEST(StateDigest, TakesZerosOfEitherSignAndFlushedNumbersForEqual) {
  const auto digest = [](Precision precision, std::vector<double> fields) {
    StateDigest result(precision);
    result.add(fields);
    return result.value();
  };
  EXPECT_EQ(digest(Precision::f64, {0.0, 1.0}), digest(Precision::f64, {-0.0, 1.0}));
  EXPECT_EQ(digest(Precision::f64, {0x1p-1001}), digest(Precision::f64, {0.0}));
  EXPECT_EQ(digest(Precision::f32, {0x1p-121}), digest(Precision::f32, {0.0}));
  EXPECT_NE(digest(Precision::f64, {0x1p-121}), digest(Precision::f64, {0.0}));
  EXPECT_NE(digest(Precision::f64, {1.0}), digest(Precision::f64, {1.0 + 0x1p-52}));
  EXPECT_NE(digest(Precision::f64, {1.0, 2.0}), digest(Precision::f64, {2.0, 1.0}));
}

TEST(StateError, IsInfiniteWhereANumberIsMissing) {
  const Problem problem = fixture::make_plate(4);
  const std::vector<double> expected = random_state(problem, Model::spatial, Precision::f64, 7);
  std::vector<double> actual = expected;
  EXPECT_EQ(state_error(problem, expected, actual), 0);
  actual[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(state_error(problem, expected, actual), std::numeric_limits<double>::infinity());
}

} // namespace
} // namespace dss
