#include "experiments/run/timed/history.hpp"

#include "solver/digest.hpp"
#include "solver/error.hpp"
#include "solver/model/element_place.hpp"
#include "solver/model/reactions.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

namespace dss {
namespace {

constexpr std::array<std::string_view, 6> reaction_columns{
    "reaction_fx", "reaction_fy", "reaction_fz", "reaction_mx", "reaction_my", "reaction_mz"};
constexpr std::array<std::string_view, 13> probe_columns{
    "ux", "uy", "uz", "vx", "vy", "vz", "sxx", "syy", "szz", "syz", "sxz", "sxy", "von_mises"};

/// The number before the first comma of a line, or -1.
long step_of(std::string_view line) {
  long step = -1;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), step);
  return error == std::errc{} && end != line.data() + line.size() && *end == ',' ? step : -1;
}

} // namespace

RunHistory::RunHistory(std::string path, const Problem& problem, std::vector<Probe> probes)
    : path_(std::move(path)), problem_(problem), probes_(std::move(probes)) {}

std::string RunHistory::header() const {
  std::string header = "step,t,kinetic_energy,energy";
  if (!problem_.clamps.empty())
    for (const std::string_view column : reaction_columns) header += fmt::format(",{}", column);
  for (const Probe& probe : probes_)
    for (const std::string_view column : probe_columns)
      header += fmt::format(",{}.{}", probe.name, column);
  return header;
}

RunHistory::Sight RunHistory::sight(const Probe& probe, std::span<const double> state) const {
  const double* const fields = &state[probe.element * field_count];
  return {displacement_at(fields, probe.arm), velocity_at(fields, probe.arm),
          field_->at(probe.element, probe.place)};
}

void RunHistory::add(long step, double time, std::span<const double> state, Rotation equations,
                     std::span<const double> signals) {
  if (!field_ || equations != equations_) field_.emplace(problem_, equations);
  equations_ = equations;
  field_->take(state, signals);
  FaceSections& sections = field_->sections();
  const auto [energy_j, reactions] =
      energy_and_reactions(problem_, sections.terms(), sections.fields(), signals);
  std::vector<double> numbers{time, sections.terms().kinetic_energy(sections.fields()), energy_j};
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
  std::string line = std::to_string(step);
  for (const double number : numbers) fmt::format_to(std::back_inserter(line), ",{:.17g}", number);
  while (!rows_.empty() && rows_.back().step >= step) rows_.pop_back();
  rows_.push_back({step, std::move(line)});
}

HistoryMark RunHistory::mark() const {
  std::string text = header();
  for (const Row& row : rows_) text += "\n" + row.line;
  return {long(rows_.size()), text_digest(text)};
}

bool RunHistory::take_rows(const std::string& path, const HistoryMark& mark) {
  clear();
  if (!std::filesystem::is_regular_file(path)) return false;
  const std::string text = read_text(path);
  std::size_t from = text.find('\n');
  if (text.substr(0, from) != header()) return false;
  for (long n = 0; n < mark.rows && from != std::string::npos; ++n) {
    const std::size_t to = text.find('\n', from + 1);
    if (to == std::string::npos) return false;
    std::string line = text.substr(from + 1, to - from - 1);
    rows_.push_back({step_of(line), std::move(line)});
    from = to;
  }
  const HistoryMark found = this->mark();
  return found.rows == mark.rows && found.digest == mark.digest;
}

void RunHistory::go_on(const HistoryMark& mark) {
  if (mark.digest.empty())
    throw InputError(fmt::format("{}: the interrupted run had no history; leave --history, --every "
                                 "and --probe out",
                                 path_));
  if (!take_rows(part(), mark) && !take_rows(path_, mark))
    throw InputError(
        fmt::format("{}: neither this file nor {} has the rows of the interrupted run; "
                    "give its --history and --probe, or leave them out",
                    path_, part()));
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

void RunHistory::write(AtomicFile& file) const {
  file.write(header() + "\n");
  for (const Row& row : rows_) file.write(row.line + "\n");
}

void RunHistory::write(FileSet& outputs) const {
  AtomicFile& file = outputs.open(path_);
  write(file);
  file.finish();
  std::error_code ignored;
  std::filesystem::remove(part(), ignored);
}

std::string RunHistory::save() const {
  try {
    AtomicFile file(part());
    write(file);
    file.commit();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

} // namespace dss
