#include "experiments/studies/study.hpp"
#include "experiments/studies/advise/advise_study.hpp"

#include <fmt/format.h>

namespace dss {
namespace {

class AdviceTrials : public Study {
public:
  explicit AdviceTrials(const StudyFile& file) : study_(read_advise(file)) {}

  std::string plan(const StudyPaths&) const override {
    return fmt::format("{}: advice on {} scenes at {} tolerances\n", study_.name,
                       study_.cases.size(), study_.tolerances.size());
  }

  StudyResult run(const StudyRun& how) override {
    const Table table = advise_table(study_, how.paths.oracle_directory, how.note());
    return result_of(study_.name, table, advise_study_text(study_, table));
  }

private:
  const AdviseStudy study_;
};

} // namespace

extern const StudyKind advise_kind;
const StudyKind advise_kind{"advise", read_study<AdviceTrials>};

} // namespace dss
