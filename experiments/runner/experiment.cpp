#include "experiments/runner/experiment.hpp"
#include "experiments/runner/cell_record.hpp"
#include "experiments/runner/child.hpp"
#include "experiments/runner/circumstances.hpp"
#include "experiments/runner/clock.hpp"
#include "experiments/runner/commands.hpp"
#include "experiments/runner/context.hpp"
#include "experiments/runner/device_ceilings.hpp"
#include "experiments/runner/expected_files.hpp"
#include "experiments/runner/precision/precision_report.hpp"
#include "experiments/runner/precision/precision_table.hpp"
#include "experiments/runner/progress.hpp"
#include "experiments/runner/samples.hpp"
#include "experiments/runner/scaling.hpp"
#include "experiments/runner/statistics.hpp"
#include "experiments/runner/tables.hpp"
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
constexpr long oversubscribed_repetitions = 1; // shown, and no claim made of it: its time is better spent on the others

/// A cell on its way: what of it is done, and whether more is wanted.
struct CellState {
  const Cell* cell = nullptr;
  std::vector<Record> records;
  bool is_broken = false; ///< a repetition failed; no more are tried
  double process_s = 0;   ///< of the last repetition
  long done = 0;          ///< repetitions recorded
  bool is_converged = false;
  bool is_partner = false;        ///< other cells are compared with it: it goes on as long as any of them does
  bool is_oversubscribed = false; ///< a time to be shown, of which no claim is made
};

class ExperimentRun {
public:
  ExperimentRun(const Study& study, const std::string& directory, bool resume, const std::string& program)
      : study_(study), paths_(experiment_paths(directory, study.name)), program_(program),
        file_(paths_.raw, raw_columns(), resume), start_(Clock::now()), cores_(usable_cores()),
        expected_(study, paths_.oracle_directory, resume, [this](const std::string& line) { progress_.note(line); }) {
    for (const Cell& cell : study.cells)
      cells_.push_back({&cell, {}, false, 0, 0, false, is_partner(cell), cell.is_oversubscribed(cores_)});
    take_over(file_.present());
  }

  bool measure() {
    for (CellState& state : cells_)
      if (!state.cell->skipped.empty() && state.records.empty())
        record(state, failure_record(place(*state.cell, 0, 0), state.cell->skipped_status(), state.cell->skipped));
    if (uses_devices(study_)) {
      progress_.note("devices: measuring their memory bandwidth and peak arithmetic");
      ceilings_ = DeviceCeilingsHere(program_);
    }
    for (long repetition = 0; repetition < study_.scale.max_repetitions && is_more_wanted(); ++repetition) {
      if (!round(repetition)) break;
      update_convergence();
    }
    return finish();
  }

private:
  double elapsed_s() const { return seconds_since(start_); }

  /// Cells that failed before are tried again.
  void take_over(const std::vector<Record>& present) {
    if (present.empty()) return;
    require_same_circumstances(paths_.context, study_);
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
    file_.append(row);
    if (!has_context_) { // until a measured process tells its own, that of this one
      write_circumstances(paths_.context, context_.is_null() ? nlohmann::json(measurement_context()) : context_,
                          study_);
      has_context_ = !context_.is_null();
    }
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
      state.is_converged = long(wall.count) >= study_.scale.min_repetitions && half && *half <= study_.scale.half_width;
    }
  }

  bool is_more_wanted() const {
    return std::any_of(cells_.begin(), cells_.end(), [&](const CellState& state) { return is_wanted(state); });
  }
  bool is_wanted(const CellState& state) const {
    const long most = state.is_oversubscribed ? std::min(oversubscribed_repetitions, study_.scale.max_repetitions)
                                              : study_.scale.max_repetitions;
    return !state.is_broken && !state.is_converged && state.done < most && state.cell->skipped.empty();
  }
  /// Bases and twins go on while any cell does: speed-ups are ratios of pairs of the same round.
  bool is_partner(const Cell& cell) const {
    const bool is_base = std::find(study_.bases.begin(), study_.bases.end(), cell.variant) != study_.bases.end();
    return cell.is_twin || (is_base && cell.threads == 1 && cell.ranks == 1) || is_scaling_base(study_, cell);
  }
  bool is_still_partner(const CellState& state) const {
    return state.is_partner && !state.is_broken && !state.is_oversubscribed && state.cell->skipped.empty();
  }

  /// One repetition of every cell that wants one, in random order; false if the budget is spent.
  bool round(long repetition) {
    std::vector<CellState*> order;
    for (CellState& state : cells_)
      if (state.done <= repetition && (is_wanted(state) || is_still_partner(state))) order.push_back(&state);
    std::mt19937_64 generator(order_seed + std::uint64_t(repetition));
    for (std::size_t last = order.size(); last > 1; --last) std::swap(order[last - 1], order[generator() % last]);
    for (std::size_t place = 0; place < order.size(); ++place) {
      CellState& state = *order[place];
      if (repetition > 0 && elapsed_s() + state.process_s > study_.scale.budget_s) return false;
      repeat(state, repetition);
      show_progress(repetition, double(place + 1) / double(order.size()), state);
    }
    return true;
  }

  void show_progress(long repetition, double share_of_round, const CellState& state) {
    const double rounds = (double(repetition) + share_of_round) / double(study_.scale.max_repetitions);
    const double share = std::max(rounds, std::min(1.0, elapsed_s() / study_.scale.budget_s));
    const Record& last = state.records.back();
    const std::string wall =
        text_in(last, "wall_s").empty() ? text_in(last, "status") : fmt::format("{:.4g} s", number_in(last, "wall_s"));
    progress_.show(share, 1, fmt::format("repetition {} of {}: {}", repetition + 1, state.cell->key(), wall));
  }

  /// A repetition, again if it was contaminated and there is time: retries take at most a quarter of the budget.
  void repeat(CellState& state, long repetition) {
    for (long attempt = 0; attempt <= study_.scale.retries; ++attempt) {
      const Record row = measured(state, repetition, attempt);
      record(state, row);
      const bool is_dirty = text_in(row, "contaminated") == "true" && text_in(row, "status") == "ok";
      if (!is_dirty || state.is_oversubscribed) return; // workers that share cores wait by nature
      if (retry_s_ + state.process_s > 0.25 * study_.scale.budget_s) return;
      if (attempt < study_.scale.retries) retry_s_ += state.process_s;
    }
  }

  Record measured(CellState& state, long repetition, long attempt) {
    const Cell& cell = *state.cell;
    std::string oracle_file;
    try {
      oracle_file = expected_.file_of(cell);
    } catch (const std::exception& error) {
      return failure_record(place(cell, repetition, attempt), "failed", error.what());
    }
    const ChildResult child =
        run_child(program_, run_arguments(study_, cell, oracle_file, repetition), study_.scale.time_limit_s);
    state.process_s = child.wall_s;
    const nlohmann::json json = nlohmann::json::parse(child.output, nullptr, false);
    if (json.is_object() && json.contains("context")) context_ = json["context"];
    const std::string failure = child.failure(study_.scale.time_limit_s);
    if (cell.is_of_precision() && child.exit_code == exit_unstable) // a result: here the method ends
      return failure_record(place(cell, repetition, attempt), json.is_object() ? "unstable" : "refused", failure);
    if (json.is_object() && json.value("status", "") == "wrong")
      return result_record(place(cell, repetition, attempt), json, child.wall_s);
    if (!failure.empty())
      return failure_record(place(cell, repetition, attempt), child.timed_out ? "time limit" : "failed", failure);
    if (!json.is_object())
      return failure_record(place(cell, repetition, attempt), "failed", "its result is no JSON object");
    Record row = result_record(place(cell, repetition, attempt), json, child.wall_s);
    ceilings_.put(json, row);
    return row;
  }

  RecordPlace place(const Cell& cell, long repetition, long attempt) const {
    return {study_, cell, repetition, attempt, cores_};
  }

  bool finish() {
    const Table table = study_.precision ? precision_table(study_, all_records_) : derive_table(study_, all_records_);
    write_csv(paths_.table, table);
    const std::string text =
        study_.precision ? report_precision(study_, table, all_records_, paths_.table) : table_text(study_, table);
    fmt::print("{}\nTable: {}\nRecords: {}\n", text, paths_.table, paths_.raw);
    return std::all_of(table.rows.begin(), table.rows.end(), [](const Record& row) {
      static const std::set<std::string> fine = {"",        "ok",       "skipped",   "unavailable", "oversubscribed",
                                                 "refused", "unstable", "inaccurate"};
      return fine.contains(text_in(row, "status"));
    });
  }

  const Study& study_;
  ExperimentPaths paths_;
  std::string program_;
  bool has_context_ = false;
  nlohmann::json context_; ///< of the last child
  RecordFile file_;
  Clock::time_point start_;
  int cores_;
  DeviceCeilingsHere ceilings_;
  std::vector<CellState> cells_;
  std::vector<Record> all_records_;
  double retry_s_ = 0;
  Progress progress_;
  ExpectedFiles expected_;
};

void make_directories(const ExperimentPaths& paths) {
  for (const std::string& path : {paths.raw, paths.table, paths.oracle_directory + "/x"}) {
    std::error_code error;
    fs::create_directories(fs::path(path).parent_path(), error);
    if (error)
      throw InputError(
          fmt::format("--out: cannot make {}: {}", fs::path(path).parent_path().string(), error.message()));
    require_writable(path);
  }
}

/// Seconds of trying a study must not cost the records of hours.
void require_same_scale(const std::string& raw, const Study& study) {
  if (!fs::exists(raw)) return;
  for (const Record& record : read_csv(raw).rows)
    if (const std::string scale = text_in(record, "scale"); scale != study.scale.name)
      throw InputError(fmt::format("{}: holds records of scale \"{}\", which scale \"{}\" would replace; give another "
                                   "--out, or --resume to add to them",
                                   raw, scale, study.scale.name));
}

} // namespace

ExperimentPaths experiment_paths(const std::string& directory, const std::string& name) {
  return {fmt::format("{}/raw/{}.csv", directory, name), fmt::format("{}/raw/{}.json", directory, name),
          fmt::format("{}/tables/{}.csv", directory, name), directory + "/oracle"};
}

bool run_experiment(const Study& study, const std::string& directory, bool resume, const std::string& program) {
  const ExperimentPaths paths = experiment_paths(directory, study.name);
  if (!resume) require_same_scale(paths.raw, study);
  make_directories(paths);
  return ExperimentRun(study, directory, resume, program).measure();
}

} // namespace dss
