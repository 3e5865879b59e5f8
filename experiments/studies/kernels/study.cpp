#include "experiments/measure/circumstances.hpp"
#include "experiments/measure/kernels/likwid_markers.hpp"
#include "experiments/run/plan/context.hpp"
#include "experiments/studies/kernels/micro_study.hpp"
#include "experiments/studies/kernels/micro_tables.hpp"
#include "solver/cores.hpp"
#include "variants/isa/denormals.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <set>

namespace dss {
namespace {

/// Every case once, though several sets may ask for it.
std::vector<MicroCase> all_cases(const MicroStudy& study) {
  std::vector<MicroCase> cases;
  std::set<std::string> known;
  for (const MicroSet& set : study.sets)
    for (MicroCase& one : micro_cases(set))
      if (known.insert(one.cell()).second) cases.push_back(std::move(one));
  return cases;
}

/// Measured anew as a whole, resumed or not: its times are compared within rounds.
Table attribution_table(const MicroStudy& study, const std::vector<Ceiling>& ceilings,
                        const std::string& raw_path, Progress& progress) {
  Table table{attribution_columns(), {}};
  RecordFile raw(raw_path, attribution_raw_columns(), false);
  for (const AttributionCase& one : study.attribution) {
    progress.note(fmt::format("attribution: {} {} {}, n = {}", one.variant, name(one.model),
                              name(one.precision), one.n));
    try {
      for (Record& row :
           attribute_step(one, study.attribution_rounds, study.attribution_sample_s, ceilings, raw))
        table.rows.push_back(std::move(row));
    } catch (const InputError& error) {
      table.rows.push_back({{"variant", one.variant},
                            {"model", std::string(name(one.model))},
                            {"precision", std::string(name(one.precision))},
                            {"status", "skipped"},
                            {"reason", error.what()}});
    }
  }
  return table;
}

std::vector<int> ceiling_threads() {
  return usable_cores() > 1 ? std::vector<int>{1, usable_cores()} : std::vector<int>{1};
}

class Kernels : public Study {
public:
  explicit Kernels(MicroStudy study) : study_(std::move(study)) {}
  explicit Kernels(const StudyFile& file) : Kernels(read_micro_study(file)) {}

  std::string plan(const StudyPaths&) const override {
    return fmt::format("{}: {} sets of microbenchmarks, {} repetitions, {} steps to attribute\n",
                       study_.name, study_.sets.size(), study_.rules.repetitions,
                       study_.attribution.size());
  }

  StudyResult run(const StudyRun& how) override {
    const StudyPaths& paths = how.paths;
    const std::vector<MicroCase> cases =
        all_cases(study_); // wrong names are refused before anything is moved
    make_room_for_records(paths.raw, paths.context, circumstances(), how.resumes);
    flush_denormals();
    RecordFile records(paths.raw, micro_columns(), how.resumes);
    write_context(paths, records);
    StudyResult result;
    const std::vector<Ceiling> ceilings = ceilings_of(how, result.tables);
    run_micro_cases(study_.name, cases, study_.rules, records,
                    [&](double done, double total, const std::string& what) {
                      how.progress.show(done, total, what);
                    });
    const Table kernels = kernel_table(read_csv(paths.raw).rows, ceilings);
    result.tables.insert(result.tables.begin(), {study_.name, kernels});
    if (!study_.attribution.empty())
      result.tables.push_back(
          {"attribution",
           attribution_table(study_, ceilings, study_paths(how.directory, "attribution").raw,
                             how.progress)});
    result.text = fmt::format("{} ({})\n{}", study_.title, study_.name, kernel_text(kernels));
    result.is_fine = std::ranges::none_of(
        kernels.rows, [](const Record& row) { return text_in(row, "status") == "wrong"; });
    return result;
  }
  bool keeps_records() const override { return true; }

private:
  Circumstances circumstances() const {
    return {study_.name, study_.title, study_.scale, study_.path, {}};
  }

  void write_context(const StudyPaths& paths, const RecordFile& records) const {
    if (!records.present().empty()) return note_resumption(paths.context);
    nlohmann::json context = measurement_context();
    const std::string no_counters = why_no_counters(), no_markers = why_no_markers();
    context["hardware_counters"] =
        no_counters.empty() ? "available" : "unavailable: " + no_counters;
    context["likwid_markers"] = no_markers.empty() ? "counted" : "unavailable: " + no_markers;
    write_circumstances(paths.context, context, circumstances());
  }

  /// Those of an earlier run, if they are wanted again or not asked for now; else measured now.
  std::vector<Ceiling> ceilings_of(const StudyRun& how, std::vector<NamedTable>& tables) const {
    const std::string path = study_paths(how.directory, "ceilings").table;
    std::vector<Ceiling> ceilings;
    if (std::filesystem::exists(path) && (how.resumes || !study_.has_ceilings))
      ceilings = read_ceilings(read_csv(path));
    if (!ceilings.empty() || !study_.has_ceilings) return ceilings;
    ceilings = measure_ceilings(ceiling_threads(), how.note());
    tables.push_back({"ceilings", ceiling_table(ceilings)});
    return ceilings;
  }

  const MicroStudy study_;
};

} // namespace

std::unique_ptr<Study> kernel_study(MicroStudy study) {
  return std::make_unique<Kernels>(std::move(study));
}

extern const StudyKind kernels_kind;
const StudyKind kernels_kind{"microbenchmarks", read_study<Kernels>};

} // namespace dss
