#include "experiments/studies/study.hpp"
#include "experiments/studies/balance/balance_study.hpp"

#include <fmt/format.h>

namespace dss {
namespace {

std::string balance_plan(const BalanceStudy& study) {
  return fmt::format("{}: {} rows of a model\n", study.name, balance_table(study).rows.size());
}

} // namespace

extern const StudyKind balance_kind;
const StudyKind balance_kind{
    "balance", read_study<TableStudy<read_balance, balance_plan, balance_table, balance_text>>};

} // namespace dss
