#include "experiments/studies/study.hpp"
#include "experiments/studies/verification/verification_study.hpp"

#include <fmt/format.h>

namespace dss {
namespace {

class Verification : public Study {
public:
  explicit Verification(const StudyFile& file) : study_(read_verification(file)) {}

  std::string plan(const StudyPaths&) const override {
    return fmt::format("{}: {} problems against their references\n", study_.name,
                       study_.problems.size());
  }

  StudyResult run(const StudyRun& how) override {
    const VerificationTables tables = verification_tables(study_, how.note());
    return {{{study_.name, tables.figures}, {study_.name + "_grids", tables.grids}},
            verification_text(study_, tables.figures),
            !has_failed_rows(tables.figures)};
  }

private:
  const VerificationStudy study_;
};

} // namespace

extern const StudyKind verification_kind;
const StudyKind verification_kind{"verification", read_study<Verification>};

} // namespace dss
