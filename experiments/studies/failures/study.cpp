#include "experiments/studies/study.hpp"
#include "experiments/studies/failures/failure_study.hpp"

#include <fmt/format.h>

namespace dss {
namespace {

class FailureAtlas : public Study {
public:
  explicit FailureAtlas(const StudyFile& file) : study_(read_failures(file)) {}

  std::string plan(const StudyPaths&) const override {
    return fmt::format("{}: {} cases against theory\n", study_.name, study_.cases.size());
  }

  StudyResult run(const StudyRun&) override {
    const Table table = failures_table(study_);
    return result_of(study_.name, table, failures_text(study_, table));
  }

private:
  const FailureStudy study_;
};

} // namespace

extern const StudyKind failures_kind;
const StudyKind failures_kind{"failures", read_study<FailureAtlas>};

} // namespace dss
