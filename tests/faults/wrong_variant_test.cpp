/// Variants that are wrong on purpose: each adds one small fault to a correct one. `verify` must
/// catch every fault.
#include "experiments/run/verify/verify.hpp"
#include "tests/fixtures/spinning_element.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace dss {
namespace {

enum class Fault {
  none,
  rate,
  last_element,
  last_bit,
  lost_step,
  threads,
  not_a_number,
  unwritten,
  weak_links,
  inertia,
  threads_not_finite,
  not_finite_at_full_step
};
Fault fault = Fault::none;
double full_step_s = 0; ///< of the scene

/// The correct executor with the fault added.
class WrongExecutor final : public Executor {
public:
  explicit WrongExecutor(const Setup& setup) : setup_(setup), problem_(setup.problem) {
    if (fault == Fault::weak_links)
      for (Body& body : problem_.bodies)
        for (AxisConstants& constants : body.axis) {
          constants.k_normal *= 0.999;
          for (double& k : constants.k_shear) k *= 0.999;
        }
    if (fault == Fault::inertia)
      for (Body& body : problem_.bodies) body.inertia[2] *= 0.999;
    right_ = load_variant("avx2").create(
        {problem_, setup.method, setup.model, setup.precision, setup.dt, setup.threads});
  }
  void write(std::size_t first, std::span<const double> fields) override {
    right_->write(first, fields);
  }
  void read(std::size_t first, std::span<double> fields) override {
    if (fault == Fault::unwritten) return; // leaves the old content of the caller's buffer
    right_->read(first, fields);
    double& last = fields[fields.size() - field_count + ux];
    if (fault == Fault::last_element)
      last *= 1 + (setup_.precision == Precision::f64 ? 1e-8 : 1e-3);
    if (fault == Fault::last_bit) last = std::nextafter(last, 1.0);
    if (fault == Fault::threads && setup_.threads == 3) last = std::nextafter(float(last), 1.0f);
    if (fault == Fault::not_a_number) last = std::nan("");
  }
  void derivative(std::span<const double> signals, std::span<double> rates) override {
    right_->derivative(signals, rates);
    if (fault == Fault::rate)
      rates[rates.size() - field_count + vx] *=
          1 + (setup_.precision == Precision::f64 ? 1e-12 : 1e-4);
  }
  Outcome advance(long steps, std::span<const double> signals) override {
    const std::size_t row = 3 + setup_.problem.loads.size();
    const bool is_short = fault == Fault::lost_step && steps > 1;
    if ((fault == Fault::threads_not_finite && setup_.threads > 1) ||
        (fault == Fault::not_finite_at_full_step && setup_.dt == full_step_s))
      return {false, steps - 1, 0};
    return right_->advance(
        is_short ? steps - 1 : steps,
        is_short ? signals.first(signals.size() - row * std::size_t(setup_.method.stages))
                 : signals);
  }
  std::string schedule() const override { return right_->schedule(); }
  int workers() const override { return right_->workers(); }
  std::size_t bytes() const override { return right_->bytes(); }

private:
  Setup setup_;
  Problem problem_;
  std::unique_ptr<Executor> right_;
};

constexpr Plugin wrong{plugin_abi,
                       "wrong",
                       "x86-64-v3",
                       true,
                       true,
                       false,
                       [](const Setup& setup) -> std::unique_ptr<Executor> {
                         return std::make_unique<WrongExecutor>(setup);
                       },
                       nullptr};

/// Empty if avx2, which the wrong variant computes by, can run here.
std::string why_no_avx2() {
  const auto avx2 = std::ranges::find(variants(), "avx2", &VariantStatus::name);
  return avx2 == variants().end() ? "" : avx2->unusable;
}

/// Names of the failed checks in f64 of the spatial model. Only the wrong variant may be blamed.
std::vector<std::string> failed_checks(Fault injected,
                                       const Scene& scene = load_scene("two_elements")) {
  fault = injected;
  full_step_s = scene.problem.dt;
  std::vector<std::string> names;
  for (const VerifyRow& row : verify_scene(scene, 60, {&load_variant("avx2"), &wrong})) {
    if (row.verdict != VerifyRow::Verdict::failed) continue;
    EXPECT_EQ(row.variant, "wrong") << row.check << ": " << row.reason;
    if (row.model == "spatial" && row.precision == "f64") names.push_back(row.check);
  }
  return names;
}

TEST(Verify,
     passes_what_is_right_and_catches_every_injected_fault_by_the_check_that_is_there_for_it) {
  if (const std::string why = why_no_avx2(); !why.empty()) GTEST_SKIP() << why;
  EXPECT_TRUE(failed_checks(Fault::none).empty());
  for (const auto& [injected, check] :
       {std::pair(Fault::rate, "evaluation"), std::pair(Fault::last_element, "run rk4"),
        std::pair(Fault::last_bit, "bits rk4"), std::pair(Fault::lost_step, "run rk4"),
        std::pair(Fault::threads, "threads rk4"), std::pair(Fault::not_a_number, "run rk4"),
        std::pair(Fault::unwritten, "run rk4"), std::pair(Fault::weak_links, "run rk4"),
        std::pair(Fault::weak_links, "run smoothed_verlet"),
        std::pair(Fault::lost_step, "run smoothed_verlet"),
        std::pair(Fault::threads_not_finite, "threads rk4"),
        std::pair(Fault::not_finite_at_full_step, "run rk4")}) {
    const std::vector<std::string> failed = failed_checks(injected);
    EXPECT_NE(std::find(failed.begin(), failed.end(), check), failed.end())
        << "fault " << int(injected);
  }
}

TEST(Verify, catches_faults_where_runs_are_judged_by_the_fall_of_their_errors) {
  if (const std::string why = why_no_avx2(); !why.empty()) GTEST_SKIP() << why;
  const Scene spinning = fixture::spinning_element();
  EXPECT_TRUE(failed_checks(Fault::none, spinning).empty());
  for (const Fault injected : {Fault::inertia, Fault::lost_step, Fault::unwritten,
                               Fault::not_a_number, Fault::not_finite_at_full_step}) {
    const std::vector<std::string> failed = failed_checks(injected, spinning);
    EXPECT_NE(std::find(failed.begin(), failed.end(), "run rk4"), failed.end())
        << "fault " << int(injected);
  }
}

} // namespace
} // namespace dss
