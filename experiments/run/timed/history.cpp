#include "experiments/run/timed/history.hpp"

#include "solver/error.hpp"
#include "solver/model/element_place.hpp"
#include "solver/model/reactions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iterator>
#include <string_view>
#include <utility>

namespace dss {
namespace {

constexpr std::array<std::string_view, 6> reaction_columns{
    "reaction_fx", "reaction_fy", "reaction_fz", "reaction_mx", "reaction_my", "reaction_mz"};
constexpr std::array<std::string_view, 13> probe_columns{
    "ux", "uy", "uz", "vx", "vy", "vz", "sxx", "syy", "szz", "syz", "sxz", "sxy", "von_mises"};

} // namespace

RunHistory::RunHistory(std::string path, const Problem& problem, std::vector<Probe> probes)
    : path_(std::move(path)), problem_(problem), probes_(std::move(probes)) {}

std::string RunHistory::columns() const {
  std::string names = "step,t,kinetic_energy,energy";
  if (!problem_.clamps.empty())
    for (const std::string_view column : reaction_columns) names += fmt::format(",{}", column);
  for (const Probe& probe : probes_)
    for (const std::string_view column : probe_columns)
      names += fmt::format(",{}.{}", probe.name, column);
  return names;
}

RunHistory::Sight RunHistory::sight(const Probe& probe, std::span<const double> state) const {
  const double* const fields = &state[probe.element * field_count];
  return {displacement_at(fields, probe.arm), velocity_at(fields, probe.arm),
          field_->at(probe.element, probe.place)};
}

std::size_t RunHistory::width() const {
  return 4 + (problem_.clamps.empty() ? 0 : reaction_columns.size()) +
         probes_.size() * probe_columns.size();
}

void RunHistory::add(long step, double time, std::span<const double> state, Rotation equations,
                     std::span<const double> signals) {
  if (!field_ || equations != equations_) field_.emplace(problem_, equations);
  equations_ = equations;
  field_->take(state, signals);
  FaceSections& sections = field_->sections();
  const auto [energy_j, reactions] =
      energy_and_reactions(problem_, sections.terms(), sections.fields(), signals);
  std::vector<double> numbers{double(step), time,
                              sections.terms().kinetic_energy(sections.fields()), energy_j};
  const auto put = [&](const auto& more) {
    numbers.insert(numbers.end(), more.begin(), more.end());
  };
  if (reactions) put(reactions->force), put(reactions->moment);
  last_.clear();
  for (const Probe& probe : probes_) {
    const Sight& seen = last_.emplace_back(sight(probe, state));
    put(seen.displacement), put(seen.velocity), put(seen.stress);
    numbers.push_back(von_mises(seen.stress));
  }
  if (!std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); }))
    throw UnstableError(fmt::format("{}: a number of the history is beyond the range of numbers at "
                                    "t = {:g} s; take a smaller --dt",
                                    problem_.name, time));
  while (!numbers_.empty() && this->step(0) >= double(step))
    numbers_.resize(numbers_.size() - width());
  numbers_.insert(numbers_.end(), numbers.begin(), numbers.end());
}

void RunHistory::go_on(const HistoryRows& rows) {
  if (rows.columns.empty())
    throw InputError(fmt::format("{}: the interrupted run had no history; leave --history, --every "
                                 "and --probe out",
                                 path_));
  if (rows.columns != columns() || rows.numbers.size() % width() != 0)
    throw InputError(fmt::format("{}: the interrupted run had other columns; give its --probe, or "
                                 "leave --history, --every and --probe out",
                                 path_));
  numbers_ = rows.numbers;
  if (numbers_.size() / width() > 2 && step(0) - step(1) != step(1) - step(2))
    numbers_.resize(numbers_.size() - width());
}

std::vector<std::string> RunHistory::probe_texts() const {
  std::vector<std::string> texts;
  for (std::size_t n = 0; n < probes_.size(); ++n) {
    texts.push_back(probes_[n].text);
    if (n >= last_.size()) continue;
    texts.back() += fmt::format("; displacement ({:.6g}) m, von Mises stress {:.6g} Pa",
                                fmt::join(last_[n].displacement, ", "), von_mises(last_[n].stress));
  }
  return texts;
}

void RunHistory::write(FileSet& outputs) const {
  AtomicFile& file = outputs.open(path_);
  file.write(columns() + "\n");
  for (std::size_t at = 0; at < numbers_.size(); at += width()) {
    std::string line = fmt::format("{:.0f}", numbers_[at]);
    for (const double number : std::span(numbers_).subspan(at + 1, width() - 1))
      fmt::format_to(std::back_inserter(line), ",{:.17g}", number);
    file.write(line + "\n");
  }
  file.finish();
}

} // namespace dss
