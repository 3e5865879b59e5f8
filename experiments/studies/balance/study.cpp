#include "experiments/studies/study.hpp"
#include "experiments/studies/balance/balance_study.hpp"

#include <fmt/format.h>

namespace dss {
namespace {

class BalanceModel : public Study {
public:
  explicit BalanceModel(const StudyFile& file) : study_(read_balance(file)) {}

  std::string plan(const StudyPaths&) const override {
    return fmt::format("{}: {} rows of a model\n", study_.name, balance_table(study_).rows.size());
  }

  StudyResult run(const StudyRun&) override {
    const Table table = balance_table(study_);
    return result_of(study_.name, table, balance_text(study_, table));
  }

private:
  const BalanceStudy study_;
};

} // namespace

extern const StudyKind balance_kind;
const StudyKind balance_kind{"balance", read_study<BalanceModel>};

} // namespace dss
