#include "experiments/run/advise/finals.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <limits>

namespace dss {
namespace {

constexpr double finalist_share = 1.3; ///< relative to the cheapest candidate's time
constexpr std::size_t most_finalists = 8;
constexpr int final_rounds = 5;
constexpr double final_sample_s = 4e-3; ///< shortest time of a run in a round

} // namespace

double Finals::Entry::best_s() const {
  return times_s.empty() ? std::numeric_limits<double>::infinity()
                         : *std::ranges::min_element(times_s);
}

void Finals::measure() {
  look_at_paper();
  enter();
  run_rounds();
  take();
}

void Finals::look_at_paper() {
  PaperRun& paper = advice_.paper;
  if (!paper.reason.empty()) return;
  if (paper.time_s > left_s_) {
    paper.reason = "it would take longer than what is left of --budget";
    return;
  }
  const Observation observation = bench_.run(paper.configuration);
  left_s_ -= observation.wall_s;
  if (!observation.failure.empty())
    paper.reason = observation.failure;
  else
    paper.error = bench_.error(advice_.reference.observed, observation.observed);
}

void Finals::enter() {
  std::vector<Candidate*> finalists;
  for (Candidate& candidate : advice_.candidates)
    if (candidate.status == Candidate::Status::meets) finalists.push_back(&candidate);
  std::ranges::sort(finalists, {}, &Candidate::time_s);
  for (Candidate* candidate : finalists) {
    if (entries_.size() >= most_finalists ||
        candidate->time_s > finalist_share * finalists.front()->time_s)
      break;
    // only variants of the same kind (with or without FMA) give the bits that were judged
    const bool has_fma = load_variant(candidate->configuration.variant).has_fma;
    for (const Target& target : costs_.near_best(candidate->configuration, finalist_share)) {
      if (load_variant(target.variant).has_fma != has_fma) continue;
      entries_.push_back({candidate, candidate->configuration, {}});
      entries_.back().configuration.variant = target.variant;
      entries_.back().configuration.threads = target.threads;
    }
  }
  if (advice_.paper.error) entries_.push_back({nullptr, advice_.paper.configuration, {}});
}

/// Runs the entries in turn, so that other load on the machine affects all of them.
void Finals::run_rounds() {
  for (int round = 0; round < final_rounds; ++round)
    for (Entry& entry : entries_) {
      const double expected_s =
          std::max(final_sample_s,
                   entry.candidate != nullptr ? entry.candidate->time_s : advice_.paper.time_s);
      if (2 * expected_s > left_s_) continue;
      entry.times_s.push_back(bench_.run_time(entry.configuration, final_sample_s));
      left_s_ -= 2 * expected_s;
    }
}

void Finals::take() {
  for (Entry& entry : entries_) {
    if (entry.times_s.empty()) continue;
    if (entry.candidate == nullptr) {
      advice_.paper.time_s = entry.best_s();
      advice_.paper.is_timed = true;
      continue;
    }
    const bool is_first = std::ranges::none_of(entries_, [&](const Entry& other) {
      return other.candidate == entry.candidate && other.best_s() < entry.best_s();
    });
    if (!is_first) continue;
    entry.candidate->configuration = entry.configuration;
    entry.candidate->time_s = entry.best_s();
    entry.candidate->is_timed = true;
  }
}

} // namespace dss
