#include "experiments/run/ensemble/member_batch.hpp"

#include "experiments/run/state/state_access.hpp"
#include "solver/error.hpp"
#include "solver/model/needed_terms.hpp"
#include "solver/numerics/signal_rows.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <tuple>

namespace dss {
namespace {

/// Puts rows of the members side by side: each number of all members, then the next.
void put_in_lane(std::span<const double> from, std::size_t lane, std::size_t lanes,
                 std::span<double> all) {
  for (std::size_t n = 0; n < from.size(); ++n) all[n * lanes + lane] = from[n];
}

/// What members of a batch have in common, besides the topology.
struct Likeness {
  std::string model, method;
  int stages;
  long steps;
  std::size_t loads;
  std::vector<int> terms; ///< of each body, and whether it is accelerated
  auto operator<=>(const Likeness&) const = default;
};

Likeness likeness(const RunPlan& plan) {
  const Problem& problem = plan.scene.problem;
  Likeness like{std::string(name(plan.model)), std::string(plan.method->name),
                plan.method->stages,           plan.steps,
                problem.loads.size(),          {}};
  for (const Terms& t : needed_terms(problem, plan.model))
    like.terms.push_back(t.is_material | t.is_damped << 1 | t.is_bending << 2 |
                         t.is_gyroscopic << 3 | t.is_tied << 4 | t.is_oblong << 5 |
                         t.has_two_shears << 6 | t.has_pressure << 7);
  like.terms.push_back(std::ranges::all_of(problem.frame_acceleration, is_zero_always));
  return like;
}

/// Whether lanes pay. A batch has a pack for each element. Single runs have fewer packs if their
/// rows are long, and all their rows: to begin one takes about as long as half a pack. Ranks take
/// whole members of a batch, and divide a single run. That makes it faster only if each rank has
/// some thousand elements, and is impossible with fewer rows than ranks (`strips`, the default).
bool fill_lanes(const Lattice& lattice, std::size_t members, int lanes, int ranks) {
  if (lanes == 1) return false;
  const std::size_t rows = lattice.rows.size();
  if (std::size_t(ranks) > rows) return true;
  if (members == 1) return false;
  const int width = lanes / ranks;
  std::size_t packs = 0;
  for (const Row& row : lattice.rows)
    packs += std::size_t((row.x_end + width - 1) / width - row.x_begin / width);
  constexpr std::size_t least_elements = 2000; // of a rank, or its exchanges take longer
  const std::size_t gain =
      std::clamp(lattice.element_count / least_elements, std::size_t(1), std::size_t(ranks));
  return gain * (2 * lattice.element_count + rows) <= members * (2 * packs + rows);
}

} // namespace

MemberBatch::MemberBatch(std::vector<const RunPlan*> members, int lanes, const Setup& setup)
    : members_(std::move(members)), failures_(members_.size()), states_(members_.size()) {
  Setup own = setup;
  if (lanes > 1) {
    std::vector<const Problem*> problems;
    std::vector<double> dt;
    for (std::size_t lane = 0; lane < std::size_t(lanes); ++lane) {
      problems.push_back(&plan_of_lane(lane).scene.problem);
      dt.push_back(plan_of_lane(lane).dt);
    }
    ensemble_ = interleave(std::move(problems), std::move(dt));
    own.ensemble = &*ensemble_;
  }
  executor_ = members_.front()->plugin->create(own);
}

void MemberBatch::restart() {
  step_ = 0;
  kept_.clear();
  std::ranges::fill(failures_, std::nullopt);
  std::ranges::fill(states_, std::vector<double>());
  std::vector<double> all;
  for (std::size_t lane = 0; lane < lanes(); ++lane) {
    const std::vector<double> state = initial_state(plan_of_lane(lane).scene.problem);
    all.resize(state.size() * lanes());
    for (std::size_t n = 0; n < state.size(); n += field_count) // element after element
      std::copy_n(&state[n], field_count, &all[n * lanes() + lane * field_count]);
  }
  executor_->write(0, all);
}

void MemberBatch::prepare(long steps) {
  next_steps_ = steps;
  for (std::size_t lane = 0; lane < lanes(); ++lane) {
    const RunPlan& plan = plan_of_lane(lane);
    const std::vector<double> rows =
        signal_rows(plan.scene.problem, *plan.method, plan.dt, step_, steps);
    signals_.resize(rows.size() * lanes());
    put_in_lane(rows, lane, lanes(), signals_);
  }
}

void MemberBatch::advance() {
  const Outcome outcome = executor_->advance(next_steps_, signals_);
  MemberOutcomes* const of_members = executor_->member_outcomes();
  for (std::size_t m = 0; m < members_.size(); ++m) {
    if (failures_[m]) continue;
    const Outcome own = of_members == nullptr ? outcome : of_members->outcomes()[m];
    if (own.is_finite) continue;
    failures_[m] = own;
    failures_[m]->step += step_;
  }
  step_ += next_steps_;
  std::ranges::fill(states_, std::vector<double>());
}

bool MemberBatch::is_alive() const {
  return std::ranges::any_of(failures_, [](const auto& failure) { return !failure; });
}

void MemberBatch::read() {
  const std::vector<double> all = whole_state(*executor_, elements() * lanes());
  for (std::size_t m = 0; m < members_.size(); ++m) {
    states_[m].resize(elements() * field_count);
    for (std::size_t n = 0; n < states_[m].size(); n += field_count)
      std::copy_n(&all[n * lanes() + m * field_count], field_count, &states_[m][n]);
  }
}

template <class Visit>
void MemberBatch::each_piece(std::size_t width, Visit&& visit) {
  constexpr std::size_t piece = 512; // elements
  std::vector<double> kept(std::min(elements(), piece) * lanes() * width);
  for (std::size_t first = 0; first < elements(); first += piece) {
    const std::size_t count = std::min(piece, elements() - first);
    visit(first * lanes(), std::span(kept).first(count * lanes() * width));
  }
}

std::vector<std::vector<double>> MemberBatch::save() {
  if (!kept_.empty()) return kept_;
  const std::size_t width = std::size_t(kept_fields(*executor_));
  std::vector<std::vector<double>> members(members_.size());
  each_piece(width, [&](std::size_t first, std::span<double> kept) {
    dss::save(*executor_, first, kept);
    for (std::size_t n = 0; n < kept.size(); n += lanes() * width)
      for (std::size_t m = 0; m < members.size(); ++m)
        members[m].insert(members[m].end(), &kept[n + m * width], &kept[n + m * width] + width);
  });
  return members;
}

const MemberStanding* MemberBatch::require_one_step(Standings members) const {
  const MemberStanding* alive = nullptr;
  const long last = members_.front()->steps;
  for (const MemberStanding* member : members) {
    if (member->failure) continue;
    if (alive == nullptr) alive = member;
    if (member->step != alive->step)
      throw InputError(
          fmt::format("members of one batch stood at steps {} and {}; give the --steps "
                      "of the interrupted run",
                      alive->step, member->step));
    if (member->step > last || (member->step == last && member->end.empty()))
      throw InputError(fmt::format("members that end at step {} were saved at step {} of a longer "
                                   "run; give more --steps",
                                   last, member->step));
  }
  return alive;
}

void MemberBatch::restore(Standings members) {
  const MemberStanding* const alive = require_one_step(members);
  restart();
  step_ = (alive == nullptr ? members.front() : alive)->step;
  for (std::size_t m = 0; m < members.size(); ++m)
    if (members[m]->failure) fail(m);
  if (alive == nullptr) return;
  if (is_done()) {
    const std::vector<double> none(elements() * field_count,
                                   std::numeric_limits<double>::quiet_NaN());
    for (std::size_t m = 0; m < members.size(); ++m) {
      states_[m] = failures_[m] ? none : members[m]->end;
      kept_.push_back(members[m]->kept);
    }
    return;
  }
  const std::size_t width = std::size_t(kept_fields(*executor_));
  each_piece(width, [&](std::size_t first, std::span<double> kept) {
    for (std::size_t n = 0; n < kept.size() / width; ++n) {
      const std::size_t element = (first + n) / lanes(), lane = n % lanes();
      const bool has_own = lane < members.size() && !failures_[lane];
      const std::vector<double>& from = (has_own ? members[lane] : alive)->kept;
      std::copy_n(&from[element * width], width, &kept[n * width]);
    }
    dss::restore(*executor_, first, kept);
  });
}

std::span<const double> MemberBatch::state(std::size_t member) {
  if (states_[member].empty()) read();
  return states_[member];
}

std::vector<BatchPlan> group_members(std::span<const RunPlan> members, int lanes, int ranks) {
  std::map<Likeness, std::vector<std::size_t>> alike;
  for (std::size_t m = 0; m < members.size(); ++m) alike[likeness(members[m])].push_back(m);
  std::vector<BatchPlan> batches;
  for (const auto& [like, all] : alike)
    for (std::size_t from = 0, to = 0; from < all.size(); from = to) {
      to = std::min(all.size(), from + std::size_t(lanes));
      if (fill_lanes(members[all[from]].scene.problem.lattice, to - from, lanes, ranks))
        batches.push_back({{&all[from], &all[from] + (to - from)}, true});
      else
        for (std::size_t n = from; n < to; ++n) batches.push_back({{all[n]}, false});
    }
  return batches;
}

} // namespace dss
