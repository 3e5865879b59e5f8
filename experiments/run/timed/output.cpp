#include "experiments/run/timed/output.hpp"
#include "experiments/base/interrupt.hpp"
#include "solver/error.hpp"
#include "solver/model/stress/stress_field.hpp"
#include "solver/numerics/signal_rows.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <utility>

namespace dss {
namespace {

bool is_finite(const SymmetricTensor& tensor) {
  return std::ranges::all_of(tensor, [](double value) { return std::isfinite(value); });
}
bool is_finite(const ElementStress& element) {
  return is_finite(element.stress) && is_finite(element.strain) &&
         std::isfinite(von_mises(element.stress));
}

/// @throws UnstableError if a stress is beyond the range of numbers; InputError if that holds from
/// the start
void require_finite(const Problem& problem, const StressField& field, Rotation equations) {
  const std::vector<ElementStress>& stress = field.elements();
  const auto wrong = std::ranges::find_if_not(
      stress, [](const ElementStress& element) { return is_finite(element); });
  if (wrong == stress.end()) return;
  const std::string what =
      fmt::format("{}: the stress of element {} is beyond the range of numbers", problem.name,
                  wrong - stress.begin());
  const StressField start(problem, initial_state(problem), equations, signals_at(problem, 0));
  if (std::ranges::all_of(start.elements(),
                          [](const ElementStress& element) { return is_finite(element); }))
    throw UnstableError(what + "; take a smaller --dt");
  throw InputError(what + "; give lengths and constants in SI units");
}

StressOutput stress_output(const Problem& problem, const std::vector<double>& state,
                           Rotation equations, std::span<const double> signals) {
  StressField field(problem, state, equations, signals);
  require_finite(problem, field, equations);
  ElementNodes nodes(problem.lattice);
  std::vector<SymmetricTensor> at_nodes = field.at_nodes(nodes);
  return {std::move(field).elements(), std::move(nodes), std::move(at_nodes)};
}

} // namespace

void write_state(FileSet& outputs, const std::string& path, const Problem& problem,
                 const std::vector<double>& state, Rotation equations,
                 std::span<const double> signals) {
  const StressField field(problem, state, equations, signals);
  require_finite(problem, field, equations);
  AtomicFile& file = outputs.open(path);
  write_state_csv(file, problem, state, field.elements());
  file.finish();
}

void FrameSeries::add(const Problem& problem, const std::vector<double>& state, Rotation equations,
                      std::span<const double> signals, double time) {
  if (output_.empty()) return;
  const std::filesystem::path path = next_file();
  try {
    const StressOutput stress = stress_output(problem, state, equations, signals);
    if (is_series_) {
      AtomicFile file(path.string());
      write_vtu(file, problem, time, state, stress);
      file.commit();
    } else {
      AtomicFile& file = outputs_->open(path.string());
      write_vtu(file, problem, time, state, stress);
      file.finish();
    }
    frames_.push_back({path.filename().string(), time});
    if (is_series_) keep_index();
  } catch (...) {
    if (!keeps_finished_) discard();
    throw;
  }
}

std::string FrameSeries::next_file() const {
  std::filesystem::path path(output_);
  if (is_series_)
    path.replace_filename(fmt::format("{}_{:04}.vtu", path.stem().string(), frames_.size()));
  return path.string();
}

void FrameSeries::go_on(const std::vector<double>& times) {
  for (const double time : times) {
    const std::filesystem::path path = next_file();
    if (!std::filesystem::is_regular_file(path))
      throw InputError(fmt::format("{}: the frame at t = {:g} s, before the checkpoint, is not "
                                   "there; give --output and --frames of the interrupted run, or "
                                   "leave them out",
                                   path.string(), time));
    frames_.push_back({path.filename().string(), time});
  }
}

void FrameSeries::keep_index() {
  constexpr double interval_s = 1; // an index of thousands of frames at each of them takes long
  if (frames_.size() > 1 && seconds_since(indexed_) < interval_s) return;
  write_pvd(index(), frames_);
  indexed_ = Clock::now();
  say_when_interrupted(fmt::format("{} lists the frames so far; give the command again", index()));
}

void FrameSeries::discard() {
  if (!is_series_) {
    outputs_->drop(output_);
    frames_.clear();
    return;
  }
  for (const Frame& frame : frames_)
    std::filesystem::remove(std::filesystem::path(output_).replace_filename(frame.file));
  if (!frames_.empty()) std::filesystem::remove(index());
  frames_.clear();
}

std::string FrameSeries::index() const {
  return std::filesystem::path(output_).replace_extension(".pvd").string();
}

std::string FrameSeries::finish() const {
  if (!is_series_ || output_.empty()) return output_;
  write_pvd(index(), frames_);
  return fmt::format("{}, which lists {} files {} to {}", index(), frames_.size(),
                     frames_.front().file, frames_.back().file);
}

} // namespace dss
