#include "experiments/studies/study.hpp"
#include "experiments/studies/mixed_nodes/mixed_study.hpp"

#include <fmt/format.h>

namespace dss {
namespace {

class MixedNodes : public Study {
public:
  explicit MixedNodes(const StudyFile& file) : study_(read_mixed(file)) {}

  std::string plan(const StudyPaths&) const override {
    return fmt::format("{}: {} cases to simulate, {} problems of {} pairs\n", study_.name,
                       study_.cases.size(), study_.held_sets.size(), study_.pairs);
  }

  StudyResult run(const StudyRun& how) override {
    const Table mixed = mixed_table(study_, how.progress);
    const Table held = held_table(study_, how.progress);
    return {{{study_.name, mixed}, {study_.name + "_held", held}},
            "\n" + mixed_text(mixed, held),
            !has_failed_rows(mixed) && !has_failed_rows(held)};
  }

private:
  const MixedStudy study_;
};

} // namespace

extern const StudyKind mixed_nodes_kind;
const StudyKind mixed_nodes_kind{"mixed_nodes", read_study<MixedNodes>};

} // namespace dss
