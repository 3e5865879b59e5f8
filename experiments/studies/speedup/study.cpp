#include "experiments/studies/study.hpp"
#include "experiments/base/child.hpp"
#include "experiments/measure/cell_plan.hpp"
#include "experiments/measure/cell_rows.hpp"
#include "experiments/measure/cell_runs.hpp"
#include "experiments/measure/oracle_checks.hpp"
#include "experiments/studies/speedup/speedup_table.hpp"
#include "solver/cores.hpp"

namespace dss {
namespace {

class SpeedupTables : public Study {
public:
  explicit SpeedupTables(const StudyFile& file) : study_(read_speedup(file, usable_cores())) {}

  std::string plan(const StudyPaths& paths) const override { return plan_text(study_, paths); }

  StudyResult run(const StudyRun& how) override {
    OracleChecks checks(study_, how.paths.oracle_directory, how.resumes, how.note());
    const Table table = derive_table(study_, run_cells(study_, how.paths, how.resumes, this_program,
                                                       checks, how.rounds, how.progress));
    return {{{study_.name, table}}, table_text(study_, table), is_without_failures(table)};
  }
  bool keeps_records() const override { return true; }
  bool has_rounds() const override { return true; }

private:
  const SpeedupStudy study_;
};

} // namespace

extern const StudyKind speedup_kind;
const StudyKind speedup_kind{"cells", read_study<SpeedupTables>, {"base"}, {"twin", "paper"}};

} // namespace dss
