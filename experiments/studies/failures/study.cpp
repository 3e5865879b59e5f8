#include "experiments/studies/study.hpp"
#include "experiments/studies/failures/failure_study.hpp"

#include <fmt/format.h>

namespace dss {
namespace {

std::string failures_plan(const FailureStudy& study) {
  return fmt::format("{}: {} cases against theory\n", study.name, study.cases.size());
}

} // namespace

extern const StudyKind failures_kind;
const StudyKind failures_kind{
    "failures",
    read_study<TableStudy<read_failures, failures_plan, failures_table, failures_text>>};

} // namespace dss
