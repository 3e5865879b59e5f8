#include "experiments/studies/study.hpp"
#include "experiments/studies/continuum/continuum_study.hpp"

#include <fmt/format.h>

namespace dss {
namespace {

class ContinuumChecks : public Study {
public:
  explicit ContinuumChecks(const StudyFile& file) : study_(read_continuum(file)) {}

  std::string plan(const StudyPaths&) const override {
    return fmt::format("{}: {} cases against theory\n", study_.name, study_.checks.size());
  }

  StudyResult run(const StudyRun&) override {
    const Table table = continuum_table(study_);
    return result_of(study_.name, table, continuum_text(study_, table));
  }

private:
  const ContinuumStudy study_;
};

} // namespace

extern const StudyKind continuum_kind;
const StudyKind continuum_kind{"continuum", read_study<ContinuumChecks>};

} // namespace dss
