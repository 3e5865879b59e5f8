#include "experiments/studies/study.hpp"
#include "experiments/studies/statics/statics_study.hpp"

#include <fmt/format.h>

namespace dss {
namespace {

class Statics : public Study {
public:
  explicit Statics(const StudyFile& file) : study_(read_statics(file)) {}

  std::string plan(const StudyPaths&) const override {
    return fmt::format("{}: {} cases against theory\n", study_.name, study_.cases.size());
  }

  StudyResult run(const StudyRun&) override {
    const Table table = statics_table(study_);
    return result_of(study_.name, table, statics_text(study_, table));
  }

private:
  const StaticsStudy study_;
};

} // namespace

extern const StudyKind statics_kind;
const StudyKind statics_kind{"statics", read_study<Statics>};

} // namespace dss
