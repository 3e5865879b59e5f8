#include "experiments/run/verify/verify.hpp"
#include "experiments/run/plan/run_plan.hpp"
#include "experiments/run/state/random_state.hpp"
#include "experiments/run/state/state_access.hpp"
#include "experiments/run/verify/expected_runs.hpp"
#include "experiments/run/verify/verified_methods.hpp"
#include "solver/error.hpp"
#include "solver/model/sufficiency/sufficiency.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "solver/reference/oracle.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <utility>

namespace dss {
namespace {

/// True for variants outside this tree, which tests/equivalence does not cover.
bool is_outside(const Plugin& plugin) {
  const auto status = std::ranges::find(variants(), plugin.name, &VariantStatus::name);
  return status != variants().end() && status->is_outside();
}

constexpr unsigned seed = 20220617;
using Verdict = VerifyRow::Verdict;

/// Collects the rows of one scene.
class SceneVerification {
public:
  SceneVerification(const Scene& scene, long steps, const std::string& device)
      : scene_(scene), problem_(scene.problem), steps_(steps), device_(device),
        expected_(problem_, steps) {}

  void verify(Model model, Precision precision, const std::vector<const Plugin*>& plugins) {
    model_ = model;
    precision_ = precision;
    first_bits_.clear();
    random_ = random_state(problem_, model, precision, seed);
    expected_rates_.assign(random_.size(), std::numeric_limits<double>::quiet_NaN());
    Oracle<long double> oracle(problem_, methods().front(), problem_.dt, rotation_of(model));
    oracle.write(random_);
    oracle.derivative(first_signals(), expected_rates_);
    for (const Plugin* plugin : plugins) {
      if (const std::string why = why_skipped(*plugin); !why.empty()) {
        add(*plugin, "all", Verdict::skipped, why);
        continue;
      }
      guarded(*plugin, "evaluation", [&] { evaluation(*plugin); });
      for (const Method* method : verified_methods(*plugin))
        guarded(*plugin, fmt::format("run {}", method->name), [&] { run(*plugin, *method); });
    }
  }

  std::vector<VerifyRow> rows;

private:
  std::vector<double> first_signals() const {
    std::vector<double> signals = signal_rows(problem_, methods().front(), problem_.dt, 0, 1);
    signals.resize(signal_count(problem_));
    return signals;
  }

  static const std::vector<Method>& methods_of(const Plugin& plugin) {
    return plugin.is_implicit ? implicit_methods() : methods();
  }

  /// Methods that are verified. All methods: in double precision, on variants with kernels of their
  /// own or with all features, for the common models. Otherwise only the brief ones: devices would
  /// compile for long, the oracle solves the equations of implicit steps slowly, and other
  /// precisions have the same coefficients.
  std::vector<const Method*> verified_methods(const Plugin& plugin) const {
    std::vector<const Method*> chosen;
    for (const Method& method : methods_of(plugin))
      if ((precision_ == Precision::f64 && (plugin.kernels != nullptr || plugin.has_all) &&
           is_common()) ||
          is_brief(method))
        chosen.push_back(&method);
    return chosen;
  }

  /// The two most used models are verified with every method on every variant.
  bool is_common() const { return model_ == Model::spatial || model_ == Model::planar; }

  /// With finite rotations, those of the variant's own description: another one has another error
  /// of a step.
  Rotation equations_of(Rotation own) const {
    const Rotation of_model = rotation_of(model_);
    return of_model == Rotation::quaternion ? own : of_model;
  }

  Setup setup_of(const Plugin& plugin, const Method& method, double dt, int threads) const {
    Setup setup{problem_, method, model_, precision_, dt, threads};
    if (plugin.devices != nullptr || device_ == no_device) setup.device = device_;
    return setup;
  }

  std::string why_skipped(const Plugin& plugin) const {
    try {
      if (const auto lack =
              what_lacks(plugin, problem_, precision_, methods_of(plugin).front(), plugin.rotation))
        return lack->what;
      if (precision_ == Precision::f32c && plugin.devices != nullptr)
        return "left to tests/equivalence: programs of their own for every scene take minutes to "
               "compile";
      if (!is_common() && plugin.kernels == nullptr && !plugin.solves_equations() &&
          !is_outside(plugin))
        return "left to tests/equivalence: this variant computes by the kernels of others, or "
               "compiles them for every "
               "scene";
      if (plugin.devices != nullptr)
        require_precision(choose_device(plugin.devices(), device_), precision_);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }

  const Tolerance& tolerance() const {
    return precision_ == Precision::f64 ? problem_.tolerance_f64 : problem_.tolerance_f32;
  }

  void add(const Plugin& plugin, const std::string& check, Verdict verdict,
           const std::string& reason, std::optional<double> error = std::nullopt,
           std::optional<double> allowed = std::nullopt) {
    rows.push_back({scene_.name, std::string(name(model_)), std::string(name(precision_)),
                    plugin.name, check, error, allowed, verdict, reason});
  }

  template <class Check>
  void guarded(const Plugin& plugin, const std::string& check, Check&& body) {
    try {
      body();
    } catch (const std::exception& error) {
      add(plugin, check, Verdict::failed, error.what());
    }
  }

  void judge_error(const Plugin& plugin, const std::string& check, double error, double allowed) {
    const bool passes = error <= allowed; // false for NaN
    add(plugin, check, passes ? Verdict::passed : Verdict::failed,
        passes ? "" : "error above the tolerance", error, allowed);
  }

  /// Variants with FMA must have the same bits. The first of them sets the expected bits.
  void judge_bits(const Plugin& plugin, const std::string& what, std::uint64_t digest) {
    if (!plugin.has_fma) return;
    const auto [first, is_first] =
        first_bits_.try_emplace(what, std::pair{std::string(plugin.name), digest});
    if (is_first) return;
    const bool equal = first->second.second == digest;
    add(plugin, "bits " + what, equal ? Verdict::passed : Verdict::failed,
        fmt::format("{} {}", equal ? "equal to" : "differ from", first->second.first));
  }

  void evaluation(const Plugin& plugin) {
    const auto executor =
        plugin.create(setup_of(plugin, methods_of(plugin).front(), problem_.dt, 1));
    executor->write(0, random_);
    std::vector<double> rates(random_.size(), std::numeric_limits<double>::quiet_NaN());
    executor->derivative(first_signals(), rates);
    judge_error(plugin, "evaluation", state_error(problem_, expected_rates_, rates),
                tolerance().evaluation);
    StateDigest digest(precision_);
    digest.add(rates);
    judge_bits(plugin, "evaluation", digest.value());
  }

  double run_error(const Outcome& outcome, Executor& executor, const ExpectedRun& expected) const {
    if (!outcome.is_finite) return std::numeric_limits<double>::infinity();
    return state_error(problem_, expected.state,
                       whole_state(executor, problem_.lattice.element_count));
  }

  /// Error at the same time with a step that is halved some times.
  double error_of_halved(const Plugin& plugin, const Method& method, int halvings) {
    const ExpectedRun& expected = expected_.run(method, equations_of(plugin.rotation), halvings);
    const long steps = steps_ << halvings;
    const auto executor = plugin.create(setup_of(plugin, method, expected.dt, 1));
    write_initial_state(*executor, problem_);
    const Outcome outcome =
        executor->advance(steps, signal_rows(problem_, method, expected.dt, 0, steps));
    return run_error(outcome, *executor, expected);
  }

  /// Kernels and oracle have equal equations for |q| = 1 alone. Runge-Kutta methods keep that
  /// length to their order. So a difference at a given time that falls by this order, as the step
  /// is halved, is the method's own. With a wrong force it would stay. Five falls are judged, or
  /// those to the tolerance. Together they may be one order short, as long steps are. A single one
  /// may be two orders short, because terms of the error can cancel, but it must be of first order
  /// at least. Errors above `asymptotic` say nothing of the order: first the step is halved until
  /// they are below.
  bool falls_by_order(const Plugin& plugin, const Method& method, double error) {
    constexpr int most_long_steps = 4, judged_falls = 5;
    constexpr double asymptotic = 0.1;
    if (method.family != Method::Family::runge_kutta || !std::isfinite(error)) return false;
    const double least_fall = std::ldexp(1, std::max(1, method.order - 2));
    double allowed_error = 0; // after all falls so far
    int long_steps = 0, falls = 0;
    while (falls < judged_falls) {
      const double before =
          std::exchange(error, error_of_halved(plugin, method, long_steps + falls + 1));
      if (before > asymptotic) {
        if (++long_steps > most_long_steps) return false;
        continue;
      }
      if (!(error * least_fall <= before)) return false;
      allowed_error = std::ldexp(falls++ == 0 ? before : allowed_error, 1 - method.order);
      if (error <= std::min(allowed_error, tolerance().run)) return true;
    }
    return error <= allowed_error;
  }

  /// True if rounding alone grows beyond the tolerance, as in motions that the model does not
  /// describe.
  bool lets_rounding_grow(const Method& method, Rotation own) {
    return !(expected_.rounding_error(method, equations_of(own), precision_) <= tolerance().run);
  }

  void judge_run(const Plugin& plugin, const Method& method, double error) {
    const std::string check = fmt::format("run {}", method.name);
    const double allowed = tolerance().run;
    if (error > allowed && falls_by_order(plugin, method, error))
      add(plugin, check, Verdict::passed, "falls by the method's order as the step is halved",
          error, allowed);
    else if (!(error <= allowed) && lets_rounding_grow(method, plugin.rotation))
      add(plugin, check, Verdict::skipped, "rounding alone grows beyond the tolerance here");
    else
      judge_error(plugin, check, error, allowed);
  }

  void run(const Plugin& plugin, const Method& method) {
    const ExpectedRun& expected = expected_.run(method, equations_of(plugin.rotation));
    const std::vector<double> signals = signal_rows(problem_, method, expected.dt, 0, steps_);
    const std::string run_name(method.name);
    std::optional<std::uint64_t>
        digest; // empty: not finite, which a run meets where it first looks
    std::string unequal;
    for (const int threads : verified_threads) {
      if (threads > 1 && !plugin.is_threaded) continue;
      if (threads > 1 && !is_brief(method)) continue;
      // more threads give more bands of the same kind
      if (threads > 3 && plugin.devices != nullptr) continue;
      const auto executor = plugin.create(setup_of(plugin, method, expected.dt, threads));
      write_initial_state(*executor, problem_);
      const Outcome outcome = executor->advance(steps_, signals);
      if (threads == 1) judge_run(plugin, method, run_error(outcome, *executor, expected));
      std::optional<std::uint64_t> bits;
      if (outcome.is_finite)
        bits = state_digest(*executor, problem_.lattice.element_count, precision_);
      if (threads == 1) digest = bits;
      if (bits != digest) unequal += fmt::format("{}{}", unequal.empty() ? "" : ", ", threads);
    }
    if (plugin.is_threaded && is_brief(method))
      add(plugin, "threads " + run_name, unequal.empty() ? Verdict::passed : Verdict::failed,
          unequal.empty() ? fmt::format("equal bits on {} threads",
                                        plugin.devices == nullptr ? "1, 2, 3, 4, 7" : "1, 2, 3")
                          : fmt::format("other bits than on 1 thread on {} threads", unequal));
    if (digest) judge_bits(plugin, run_name, *digest);
  }

  const Scene& scene_;
  const Problem& problem_;
  long steps_;
  std::string device_;
  Model model_ = Model::spatial;
  Precision precision_ = Precision::f64;
  ExpectedRuns expected_;
  std::vector<double> random_, expected_rates_;
  std::map<std::string, std::pair<std::string, std::uint64_t>> first_bits_;
};

} // namespace

std::vector<VerifyRow> verify_scene(const Scene& scene, long steps,
                                    const std::vector<const Plugin*>& plugins,
                                    const std::string& device) {
  std::vector<const Plugin*> verified = plugins;
  if (device == no_device)
    std::erase_if(verified, [](const Plugin* plugin) { return plugin->devices != nullptr; });
  SceneVerification verification(scene, steps, device);
  for (const Model model : models) {
    if (const std::string why = why_not(model, scene.problem); !why.empty()) {
      verification.rows.push_back(
          {scene.name, std::string(name(model)), "", "", "all", {}, {}, Verdict::skipped, why});
      continue;
    }
    for (const Precision precision : precisions) verification.verify(model, precision, verified);
  }
  return std::move(verification.rows);
}

} // namespace dss
