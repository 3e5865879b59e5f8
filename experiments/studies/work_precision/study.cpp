#include "experiments/studies/study.hpp"
#include "experiments/base/child.hpp"
#include "experiments/measure/cell_plan.hpp"
#include "experiments/measure/cell_rows.hpp"
#include "experiments/measure/cell_runs.hpp"
#include "experiments/studies/work_precision/precision_table.hpp"
#include "experiments/studies/work_precision/precision_text.hpp"
#include "experiments/studies/work_precision/solution_checks.hpp"
#include "solver/cores.hpp"

#include <filesystem>

namespace dss {
namespace {

class WorkPrecision : public Study {
public:
  explicit WorkPrecision(const StudyFile& file) : study_(read_precision(file, usable_cores())) {}

  std::string plan(const StudyPaths& paths) const override { return plan_text(study_, paths); }

  StudyResult run(const StudyRun& how) override {
    SolutionChecks checks(study_, how.paths.oracle_directory, how.resumes, how.note());
    const std::vector<Record> records =
        run_cells(study_, how.paths, how.resumes, this_program, checks, how.rounds, how.progress);
    const Table points = precision_table(study_, records),
                cheapest = cheapest_table(study_, points);
    const std::string budget =
        study_paths(how.directory, "error_budget").table; // whose errors in space count
    const Table comparisons = comparison_table(
        study_, points, records, std::filesystem::exists(budget) ? read_csv(budget) : Table{});
    return {{{study_.name, points},
             {study_.name + "_cheapest", cheapest},
             {study_.name + "_comparisons", comparisons}},
            precision_text(study_, points, cheapest, comparisons),
            is_without_failures(points)};
  }
  bool keeps_records() const override { return true; }
  bool has_rounds() const override { return true; }

private:
  const PrecisionStudy study_;
};

} // namespace

extern const StudyKind work_precision_kind;
const StudyKind work_precision_kind{
    "work_precision", read_study<WorkPrecision>, {"cells"}, {"base", "twin"}};

} // namespace dss
