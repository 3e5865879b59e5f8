#include "experiments/studies/study.hpp"
#include "experiments/studies/continuum/continuum_study.hpp"

#include <fmt/format.h>

namespace dss {
namespace {

std::string continuum_plan(const ContinuumStudy& study) {
  return fmt::format("{}: {} cases against theory\n", study.name, study.checks.size());
}

} // namespace

extern const StudyKind continuum_kind;
const StudyKind continuum_kind{
    "continuum",
    read_study<TableStudy<read_continuum, continuum_plan, continuum_table, continuum_text>>};

} // namespace dss
