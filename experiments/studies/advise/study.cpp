#include "experiments/studies/study.hpp"
#include "experiments/studies/advise/advise_study.hpp"

#include <fmt/format.h>

namespace dss {
namespace {

std::string advise_plan(const AdviseStudy& study) {
  return fmt::format("{}: advice on {} scenes at {} tolerances\n", study.name, study.cases.size(),
                     study.tolerances.size());
}

Table made_advise(const AdviseStudy& study, const StudyRun& how) {
  return advise_table(study, how.paths.oracle_directory, how.note());
}

} // namespace

extern const StudyKind advise_kind;
const StudyKind advise_kind{
    "advise", read_study<TableStudy<read_advise, advise_plan, made_advise, advise_study_text>>};

} // namespace dss
