#include "experiments/studies/study.hpp"
#include "experiments/studies/error_budget/error_budget.hpp"

#include <fmt/format.h>

namespace dss {
namespace {

class ErrorBudget : public Study {
public:
  explicit ErrorBudget(const StudyFile& file) : study_(read_error_budget(file)) {}

  std::string plan(const StudyPaths&) const override {
    std::string text;
    for (const BudgetScene& scene : study_.scenes)
      text += fmt::format("{}: {}, {} at dt = {:g} s to {:g} s\n", study_.name, scene.label,
                          scene.integrator, scene.dt, scene.times.end);
    return text;
  }

  StudyResult run(const StudyRun& how) override {
    const Table table = error_budget_table(study_, how.note());
    return result_of(study_.name, table, error_budget_text(study_, table));
  }

private:
  const ErrorBudgetStudy study_;
};

} // namespace

extern const StudyKind error_budget_kind;
const StudyKind error_budget_kind{"error_budget", read_study<ErrorBudget>};

} // namespace dss
