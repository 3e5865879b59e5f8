#include "experiments/measure/cell_runs.hpp"
#include "experiments/base/child.hpp"
#include "experiments/base/clock.hpp"
#include "experiments/base/exit_code.hpp"
#include "experiments/base/quiet.hpp"
#include "experiments/base/statistics.hpp"
#include "experiments/measure/cell_bases.hpp"
#include "experiments/measure/cell_record.hpp"
#include "experiments/measure/circumstances.hpp"
#include "experiments/measure/device_ceilings.hpp"
#include "experiments/measure/patience.hpp"
#include "experiments/measure/samples.hpp"
#include "experiments/run/plan/context.hpp"
#include "solver/cores.hpp"
#include "solver/error.hpp"
#include "solver/io/atomic_file.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <random>
#include <set>

namespace dss {
namespace {

namespace fs = std::filesystem;
constexpr unsigned order_seed = 20220617;
/// A time that is shown but not compared gets one repetition: with more workers than cores, or of a
/// run that checks the scaling of a shorter one.
constexpr long uncompared_repetitions = 1;

/// Progress of one cell.
struct CellState {
  const Cell* cell = nullptr;
  std::vector<Record> records;
  bool is_broken = false; ///< a repetition failed; the cell is not repeated
  double process_s = 0;   ///< process time of the last repetition [s]
  long done = 0;          ///< repetitions recorded
  bool is_converged = false;
  bool is_partner =
      false; ///< Other cells are compared with it, so it is repeated as long as any cell is.
  bool is_oversubscribed = false;
};

/// Rounds of repetitions: round r runs repetition r of all cells.
class CellRuns {
public:
  CellRuns(const CellStudy& study, const StudyPaths& paths, bool resume, const std::string& program,
           CellChecks& checks, Progress& progress)
      : study_(study), paths_(paths), program_(program), file_(paths_.raw, raw_columns(), resume),
        start_(Clock::now()), cores_(usable_cores()), progress_(progress), checks_(checks),
        patience_(study.scale.patience_s, progress, disturbance) {
    for (const Cell& cell : study.cells)
      cells_.push_back(
          {&cell, {}, false, 0, 0, false, is_partner(study, cell), cell.is_oversubscribed(cores_)});
    take_over(file_.present());
  }

  /// @param rounds  as of run_cells
  std::vector<Record> measure(long rounds) {
    for (CellState& state : cells_)
      if (!state.cell->skipped.empty() && state.records.empty())
        record(state, failure_record(place(*state.cell, 0, 0), state.cell->skipped_status(),
                                     state.cell->skipped));
    if (uses_devices(study_)) {
      progress_.note("devices: measuring their memory bandwidth and peak arithmetic");
      ceilings_ = DeviceCeilingsHere(program_);
    }
    for (long repetition = 0; repetition < study_.scale.max_repetitions && is_more_wanted();
         ++repetition) {
      const std::size_t before = all_records_.size();
      if (!round(repetition)) break;
      update_convergence();
      // A round that an earlier run measured adds nothing.
      if (all_records_.size() > before && --rounds == 0) break;
    }
    if (const std::string report = patience_.report(); !report.empty()) {
      progress_.note(study_.name + ": " + report);
      note_patience(paths_.context, report);
    }
    return all_records_;
  }

private:
  double elapsed_s() const { return seconds_since(start_); }

  /// Starts from the records of an earlier run. Cells that failed before are tried again.
  void take_over(const std::vector<Record>& present) {
    if (present.empty()) return;
    require_same_circumstances(paths_.context, circumstances_of(study_));
    has_context_ = true;
    note_resumption(paths_.context);
    for (const Record& old : present) {
      all_records_.push_back(old);
      if (text_in(old, "scale") != study_.scale.name) continue;
      for (CellState& state : cells_)
        if (state.cell->key() == text_in(old, "cell")) state.records.push_back(old);
    }
    for (CellState& state : cells_) {
      account(state);
      state.is_broken = false;
    }
    update_convergence();
  }

  void account(CellState& state) {
    const auto samples = samples_of(state.records);
    if (samples.empty()) return;
    state.done = samples[0].is_empty() ? 0 : samples[0].repetitions.rbegin()->first + 1;
    state.is_broken = text_in(samples[0].last, "wall_s").empty();
  }

  void record(CellState& state, const Record& row) {
    // Before the first record: whoever is killed in between could not resume otherwise. This
    // process's context is written until a measured process has reported its own.
    if (!has_context_) {
      file_.set_aside();
      write_circumstances(paths_.context,
                          context_.is_null() ? nlohmann::json(measurement_context()) : context_,
                          circumstances_of(study_));
      has_context_ = !context_.is_null();
    }
    file_.append(row);
    all_records_.push_back(row);
    state.records.push_back(row);
    account(state);
  }

  void update_convergence() {
    for (CellState& state : cells_) {
      const auto samples = samples_of(state.records);
      if (samples.empty() || samples[0].is_empty()) continue;
      const Estimate wall = estimate(samples[0].wall_s());
      const auto half = wall.half_width();
      state.is_converged = long(wall.count) >= study_.scale.min_repetitions && half &&
                           *half <= study_.scale.half_width;
    }
  }

  bool is_more_wanted() const {
    return std::any_of(cells_.begin(), cells_.end(),
                       [&](const CellState& state) { return is_wanted(state); });
  }
  bool is_wanted(const CellState& state) const {
    const long most =
        state.cell->is_compared(cores_) ? study_.scale.max_repetitions : uncompared_repetitions;
    return !state.is_broken && !state.is_converged && state.done < most &&
           state.cell->skipped.empty();
  }
  /// Bases and twins continue as long as any cell: speed-ups are ratios within a round.
  bool is_still_partner(const CellState& state) const {
    return state.is_partner && !state.is_broken && state.cell->is_compared(cores_) &&
           state.cell->skipped.empty();
  }

  /// Runs one repetition of every cell that needs one, in random order. Returns false if the budget
  /// is spent: it limits the repetitions beyond the least number, without which no speed-up has an
  /// interval.
  bool round(long repetition) {
    std::vector<CellState*> order;
    for (CellState& state : cells_)
      if (state.done <= repetition && (is_wanted(state) || is_still_partner(state)))
        order.push_back(&state);
    std::mt19937_64 generator(order_seed + std::uint64_t(repetition));
    for (std::size_t last = order.size(); last > 1; --last)
      std::swap(order[last - 1], order[generator() % last]);
    std::vector<CellState*> disturbed;
    for (std::size_t place = 0; place < order.size(); ++place) {
      CellState& state = *order[place];
      if (repetition >= study_.scale.min_repetitions &&
          elapsed_s() + state.process_s > study_.scale.budget_s) {
        repeat_disturbed(disturbed, repetition);
        return false;
      }
      patience_.wait();
      if (run_is_disturbed(state, repetition, 0)) disturbed.push_back(&state);
      show_progress(repetition, double(place + 1) / double(order.size()), state);
    }
    repeat_disturbed(disturbed, repetition);
    return true;
  }

  /// Runs disturbed repetitions again at the end of their round, when the machine may be quieter.
  void repeat_disturbed(std::vector<CellState*> disturbed, long repetition) {
    for (long attempt = 1; attempt <= study_.scale.retries; ++attempt)
      std::erase_if(disturbed, [&](CellState* state) {
        if (!patience_.allows(state->process_s)) return true;
        patience_.wait();
        patience_.spend(state->process_s);
        return !run_is_disturbed(*state, repetition, attempt);
      });
  }

  /// Runs a repetition and records it. True if it was contaminated. (Workers that share cores
  /// always wait, so such cells do not count.)
  bool run_is_disturbed(CellState& state, long repetition, long attempt) {
    const Record row = measured(state, repetition, attempt);
    record(state, row);
    return text_in(row, "contaminated") == "true" && text_in(row, "status") == "ok" &&
           !state.is_oversubscribed;
  }

  void show_progress(long repetition, double share_of_round, const CellState& state) {
    const double rounds =
        (double(repetition) + share_of_round) / double(study_.scale.max_repetitions);
    const double share = std::max(rounds, std::min(1.0, elapsed_s() / study_.scale.budget_s));
    const Record& last = state.records.back();
    const std::string wall = text_in(last, "wall_s").empty()
                                 ? text_in(last, "status")
                                 : fmt::format("{:.4g} s", number_in(last, "wall_s"));
    progress_.show(share, 1,
                   fmt::format("repetition {} of {}: {}", repetition + 1, state.cell->key(), wall));
  }

  Record measured(CellState& state, long repetition, long attempt) {
    const Cell& cell = *state.cell;
    std::vector<std::string> checks;
    try {
      checks = checks_.options(cell, repetition);
    } catch (const std::exception& error) {
      return failure_record(place(cell, repetition, attempt), "failed", error.what());
    }
    const ChildResult child =
        run_child(program_, run_arguments(study_, cell, checks), study_.scale.time_limit_s);
    state.process_s = child.wall_s;
    const nlohmann::json json = nlohmann::json::parse(child.output, nullptr, false);
    if (json.is_object() && json.contains("context")) context_ = json["context"];
    const std::string failure = child.failure(study_.scale.time_limit_s);
    if (checks_.is_instability_a_result() && child.exit_code == exit_unstable)
      return failure_record(place(cell, repetition, attempt),
                            json.is_object() ? "unstable" : "refused", failure);
    if (json.is_object() && json.value("status", "") == "wrong")
      return result_record(place(cell, repetition, attempt), json, child.wall_s);
    if (!failure.empty())
      return failure_record(place(cell, repetition, attempt),
                            child.timed_out ? "time limit" : "failed", failure);
    if (!json.is_object())
      return failure_record(place(cell, repetition, attempt), "failed",
                            "its result is no JSON object");
    Record row = result_record(place(cell, repetition, attempt), json, child.wall_s);
    ceilings_.put(json, row);
    return row;
  }

  RecordPlace place(const Cell& cell, long repetition, long attempt) const {
    return {study_, cell, repetition, attempt, cores_};
  }

  const CellStudy& study_;
  const StudyPaths paths_;
  std::string program_;
  bool has_context_ = false;
  nlohmann::json context_; ///< reported by the last child process
  RecordFile file_;
  Clock::time_point start_;
  int cores_;
  DeviceCeilingsHere ceilings_;
  std::vector<CellState> cells_;
  std::vector<Record> all_records_;
  Progress& progress_;
  CellChecks& checks_;
  Patience patience_;
};

/// Protects records: a short run at a small scale must not replace hours of measurement.
void require_same_scale(const std::string& raw, const CellStudy& study) {
  if (!fs::exists(raw)) return;
  for (const Record& record : read_csv(raw).rows)
    if (const std::string scale = text_in(record, "scale"); scale != study.scale.name)
      throw InputError(fmt::format(
          "{}: holds records of scale \"{}\", which scale \"{}\" would replace; give another "
          "--out, or --resume to add to them",
          raw, scale, study.scale.name));
}

} // namespace

std::vector<Record> run_cells(const CellStudy& study, const StudyPaths& paths, bool resume,
                              const std::string& program, CellChecks& checks, long rounds,
                              Progress& progress) {
  if (!resume) require_same_scale(paths.raw, study);
  make_directories(paths);
  return CellRuns(study, paths, resume, program, checks, progress).measure(rounds);
}

} // namespace dss
