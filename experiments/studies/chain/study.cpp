#include "experiments/studies/study.hpp"
#include "experiments/base/progress.hpp"
#include "experiments/base/usage.hpp"
#include "experiments/measure/circumstances.hpp"
#include "experiments/run/plan/context.hpp"
#include "experiments/run/state/state_access.hpp"
#include "experiments/studies/chain/chain_study.hpp"
#include "experiments/studies/chain/chain_table.hpp"
#include "solver/cores.hpp"
#include "variants/isa/denormals.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <set>
#include <utility>

namespace dss {
namespace {

constexpr long checked_steps = 10;
constexpr double state_tolerance = 1e-9, single_state_tolerance = 1e-4;

/// Difference of a stage's state from the expected one after a few steps. The expected state comes
/// from the variant `reference` for the spatial model in f64, else from the variant `scalar`.
double state_difference(const ChainStudy& study, const Scene& scene, const ChainStage& stage) {
  ChainStage right = stage;
  right.variant =
      stage.model == Model::spatial && stage.precision == Precision::f64 ? "reference" : "scalar";
  right.threads = 1;
  StageRun run(study, scene, stage), expected(study, scene, right);
  run.advance(checked_steps);
  expected.advance(checked_steps);
  return displacement_difference(run.state(), expected.state());
}

const std::vector<std::string>& raw_chain_columns() {
  static const std::vector<std::string> columns = {
      "experiment", "cell",         "stage",   "label",       "variant",
      "threads",    "cores",        "model",   "precision",   "integrator",
      "dt_s",       "repetition",   "steps",   "wall_s",      "cpu_s",
      "sample_s",   "contaminated", "check",   "check_error", "check_tolerance",
      "status",     "reason",       "time_utc"};
  return columns;
}

/// A repetition that other work disturbed is timed again; so many timings at most.
constexpr int most_attempts = 4;

/// One timed stage of the chain.
struct TimedStage {
  ChainStage stage;
  std::unique_ptr<StageRun> run;
  double difference = 0; ///< of its state to that of the plain code
  long steps = 1;        ///< so many take the study's sample_s
};

TimedStage timed_stage(const ChainStudy& study, const Scene& scene, const ChainStage& stage) {
  TimedStage timed{stage, std::make_unique<StageRun>(study, scene, stage),
                   state_difference(study, scene, stage)};
  StageRun& run = *timed.run;
  for (run.advance(timed.steps); run.wall_s() < study.sample_s; run.advance(timed.steps)) {
    const double growth = std::min(8.0, 1.2 * study.sample_s / run.wall_s());
    timed.steps = std::max(timed.steps + 1, long(double(timed.steps) * growth));
  }
  return timed;
}

/// All stages of a repetition with memory of its own, since times depend on where it lies. A few
/// steps, a tenth of a sample, touch it.
void renew(const ChainStudy& study, const Scene& scene, std::vector<TimedStage>& stages) {
  for (TimedStage& timed : stages) {
    timed.run = std::make_unique<StageRun>(study, scene, timed.stage);
    timed.run->advance(timed.steps / 10 + 1);
  }
}

/// Record of the run that was just timed.
Record stage_record(const ChainStudy& study, const TimedStage& timed, std::size_t n,
                    int repetition) {
  const ChainStage& stage = timed.stage;
  const double wall_s = timed.run->wall_s();
  const double tolerance =
      stage.precision == Precision::f64 ? state_tolerance : single_state_tolerance;
  const bool is_right = timed.difference <= tolerance;
  const Usage usage = timed.run->usage();
  return {{"experiment", study.name},
          {"cell", chain_cell(n, stage)},
          {"stage", fmt::format("{}", n)},
          {"label", stage.label},
          {"variant", stage.variant},
          {"threads", fmt::format("{}", stage.threads)},
          {"cores", fmt::format("{}", usable_cores())},
          {"model", std::string(name(stage.model))},
          {"precision", std::string(name(stage.precision))},
          {"integrator", stage.integrator},
          {"dt_s", number_text(timed.run->dt())},
          {"repetition", fmt::format("{}", repetition)},
          {"steps", fmt::format("{}", timed.steps)},
          {"wall_s", number_text(wall_s)},
          {"cpu_s", number_text(usage.cpu_s)},
          {"sample_s", number_text(wall_s)},
          {"contaminated", is_contaminated(usage, wall_s, stage.threads) ? "true" : "false"},
          {"check", is_right ? "passed" : "failed"},
          {"check_error", number_text(timed.difference)},
          {"check_tolerance", number_text(tolerance)},
          {"status", is_right ? "ok" : "wrong"},
          {"reason", is_right ? "" : "its state is not that of the plain code"},
          {"time_utc", measurement_time()}};
}

/// Takes the samples of a repetition. @return record of the fastest
Record fastest_sample(const ChainStudy& study, const TimedStage& timed, std::size_t n,
                      int repetition) {
  Record fastest;
  for (int sample = 0; sample < study.samples; ++sample) {
    timed.run->advance(timed.steps);
    if (fastest.empty() || timed.run->wall_s() < number_in(fastest, "wall_s"))
      fastest = stage_record(study, timed, n, repetition);
  }
  return fastest;
}

/// The stages that a repetition lacks, of each repetition that lacks any.
using Missing = std::map<int, std::vector<std::size_t>>;

Missing missing_of(const ChainStudy& study, const RecordFile& records) {
  std::set<std::pair<std::string, std::string>> present;
  for (const Record& record : records.present())
    present.emplace(text_in(record, "cell"), text_in(record, "repetition"));
  const std::vector<ChainStage> stages = study.timed();
  Missing missing;
  for (int repetition = 0; repetition < study.repetitions; ++repetition)
    for (std::size_t n = 0; n < stages.size(); ++n)
      if (!present.contains({chain_cell(n, stages[n]), fmt::format("{}", repetition)}))
        missing[repetition].push_back(n);
  return missing;
}

/// Times all stages in turn, for so many of the repetitions that are missing.
void time_stages(const ChainStudy& study, const Scene& scene, const Missing& missing, long rounds,
                 RecordFile& records, Progress& progress) {
  std::vector<TimedStage> stages;
  for (const ChainStage& stage : study.timed()) stages.push_back(timed_stage(study, scene, stage));
  const double all = double(rounds) * double(stages.size());
  double done = 0;
  for (const auto& [repetition, lacking] : missing) {
    if (rounds-- == 0) break;
    renew(study, scene, stages);
    for (const std::size_t n : lacking) {
      const TimedStage& timed = stages[n];
      progress.show(done++, all, timed.stage.label);
      for (int attempt = 0; attempt < most_attempts; ++attempt) {
        const Record record = fastest_sample(study, timed, n, repetition);
        records.append(record);
        if (text_in(record, "contaminated") != "true") break;
      }
    }
  }
}

class Chain : public Study {
public:
  explicit Chain(const StudyFile& file) : study_(read_chain(file)) {}

  std::string plan(const StudyPaths&) const override {
    std::string text;
    for (const ChainStage& stage : study_.timed())
      text +=
          fmt::format("{}: {}: {} t{} {} {} {}\n", study_.name, stage.label, stage.variant,
                      stage.threads, name(stage.model), name(stage.precision), stage.integrator);
    return text;
  }

  StudyResult run(const StudyRun& how) override {
    const StudyPaths& paths = how.paths;
    const Circumstances of{
        study_.name, study_.title, study_.scale, study_.path, {{study_.scene, study_.set}}};
    make_room_for_records(paths.raw, paths.context, of, how.resumes);
    flush_denormals();
    const Scene scene = load_scene(study_.scene, study_.set);
    for (ChainNeighbour& neighbour : study_.neighbours)
      if (neighbour.stage.steps_an_interval == 0)
        neighbour.stage.steps_an_interval = stable_steps(study_, scene.problem, neighbour.stage);
    RecordFile records(paths.raw, raw_chain_columns(), how.resumes);
    if (records.present().empty())
      write_circumstances(paths.context, measurement_context(), of);
    else
      note_resumption(paths.context);
    const Missing missing = missing_of(study_, records);
    const long all = long(missing.size()),
               rounds = how.rounds > 0 ? std::min(how.rounds, all) : all;
    if (rounds > 0) time_stages(study_, scene, missing, rounds, records, how.progress);
    if (rounds < all)
      return {
          {},
          fmt::format("{}: {} rounds are missing; go on with --resume", study_.name, all - rounds)};
    ChainErrors errors(study_, scene, how.note());
    const Table table = chain_table(study_, read_csv(paths.raw).rows, errors);
    const bool is_right = std::ranges::all_of(
        table.rows, [](const Record& row) { return text_in(row, "status") == "ok"; });
    const Record& last = table.rows[study_.stages.size() - 1];
    return {{{study_.name, table}},
            chain_text(study_, table),
            is_right && number_in(last, "error_max") <= study_.bar};
  }
  bool keeps_records() const override { return true; }
  bool has_rounds() const override { return true; }

private:
  ChainStudy study_;
};

} // namespace

extern const StudyKind chain_kind;
const StudyKind chain_kind{"chain", read_study<Chain>};

} // namespace dss
