#include "experiments/run/advise/step_costs.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <limits>

namespace dss {
namespace {

constexpr double step_timing_s = 5e-4; ///< shortest time of each timing
/// variants slower than this multiple of the fastest are not tried further
constexpr double slow_variant = 2;
constexpr double thread_gain = 0.95; ///< more threads must bring the time below this share

} // namespace

std::vector<std::string> advised_variants(const Problem& problem,
                                          const std::vector<std::string>& named) {
  for (const std::string& name : named) require_terms(load_variant(name), problem);
  if (!named.empty()) return named;
  std::vector<std::string> usable;
  const bool has_fma = load_variant("auto").has_fma;
  // variants of one kind (with or without FMA) give the same bits, so one run gives the error of
  // all
  for (auto variant = variants().rbegin(); variant != variants().rend(); ++variant)
    if (variant->is_usable() && !variant->is_by_name)
      if (const Plugin& plugin = load_variant(variant->name);
          plugin.has_fma == has_fma && missing_term(plugin, problem) == nullptr)
        usable.push_back(variant->name);
  return usable;
}

StepCosts::StepCosts(const Workbench& bench, const Configuration& base,
                     const std::vector<std::string>& variants, int most_threads)
    : bench_(bench), base_(base) {
  Configuration tried = base_;
  tried.threads = 1;
  double fastest_s = std::numeric_limits<double>::infinity();
  std::vector<std::pair<double, std::string>> kept;
  for (const std::string& variant : variants) {
    tried.variant = variant;
    const double time_s = evaluation_time(tried);
    fastest_s = std::min(fastest_s, time_s);
    kept.emplace_back(time_s, variant);
  }
  std::erase_if(kept, [&](const auto& one) { return one.first > slow_variant * fastest_s; });
  for (const auto& [time_s, variant] : kept) {
    tried.variant = variant;
    targets_.push_back({variant, 1});
    double before_s = time_s;
    if (!load_variant(variant).is_threaded) continue;
    for (int threads = 2; threads <= most_threads;
         threads = threads < most_threads ? std::min(2 * threads, most_threads) : threads + 1) {
      tried.threads = threads;
      if (bench_.workers(tried) < threads) break; // too few rows
      const double threaded_s = evaluation_time(tried);
      if (threaded_s > thread_gain * before_s) break;
      before_s = threaded_s;
      targets_.push_back({variant, threads});
    }
  }
}

double StepCosts::evaluation_time(const Configuration& configuration) {
  const Key key{configuration.model, configuration.precision, configuration.method,
                configuration.variant, configuration.threads};
  const auto known = evaluation_s_.find(key);
  if (known != evaluation_s_.end()) return known->second;
  Configuration fixed = configuration;
  fixed.rtol.reset();
  if (bench_.stages(fixed) == 0) return std::numeric_limits<double>::infinity();
  const double time_s = bench_.step_time(fixed, step_timing_s) / bench_.stages(fixed);
  return evaluation_s_[key] = time_s;
}

std::vector<Target> StepCosts::near_best(const Configuration& configuration, double share) {
  std::vector<std::pair<double, Target>> timed;
  Configuration tried = base_;
  tried.model = configuration.model;
  tried.precision = configuration.precision;
  for (const Target& target : targets_) {
    tried.variant = target.variant;
    tried.threads = target.threads;
    timed.emplace_back(evaluation_time(tried), target);
  }
  std::ranges::stable_sort(timed, {}, [](const auto& one) { return one.first; });
  std::vector<Target> near;
  for (const auto& [time_s, target] : timed)
    if (time_s <= share * timed.front().first) near.push_back(target);
  return near;
}

Configuration StepCosts::placed(Configuration configuration) {
  const Target best = near_best(configuration, 1).front();
  configuration.variant = best.variant;
  configuration.threads = best.threads;
  return configuration;
}

double StepCosts::run_time(const Configuration& configuration) {
  if (bench_.stages(configuration) == 0) return std::numeric_limits<double>::infinity();
  return evaluation_time(configuration) * bench_.stages(configuration) *
         double(bench_.steps(configuration));
}

} // namespace dss
