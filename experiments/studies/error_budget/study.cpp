#include "experiments/studies/study.hpp"
#include "experiments/studies/error_budget/error_budget.hpp"

#include <fmt/format.h>

namespace dss {
namespace {

std::string error_budget_plan(const ErrorBudgetStudy& study) {
  std::string text;
  for (const BudgetScene& scene : study.scenes)
    text += fmt::format("{}: {}, {} at dt = {:g} s to {:g} s\n", study.name, scene.label,
                        scene.integrator, scene.dt, scene.times.end);
  return text;
}

Table made_error_budget(const ErrorBudgetStudy& study, const StudyRun& how) {
  return error_budget_table(study, how.note());
}

} // namespace

extern const StudyKind error_budget_kind;
const StudyKind error_budget_kind{
    "error_budget",
    read_study<
        TableStudy<read_error_budget, error_budget_plan, made_error_budget, error_budget_text>>};

} // namespace dss
