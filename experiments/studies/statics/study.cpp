#include "experiments/studies/study.hpp"
#include "experiments/studies/statics/statics_study.hpp"

#include <fmt/format.h>

namespace dss {
namespace {

std::string statics_plan(const StaticsStudy& study) {
  return fmt::format("{}: {} cases against theory\n", study.name, study.cases.size());
}

} // namespace

extern const StudyKind statics_kind;
const StudyKind statics_kind{
    "statics", read_study<TableStudy<read_statics, statics_plan, statics_table, statics_text>>};

} // namespace dss
