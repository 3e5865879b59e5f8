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
    StudyResult result = result_of(study_.name, mixed, "\n" + mixed_text(mixed, held));
    result.tables.push_back({study_.name + "_held", held});
    return result;
  }

private:
  const MixedStudy study_;
};

} // namespace

extern const StudyKind mixed_nodes_kind;
const StudyKind mixed_nodes_kind{"mixed_nodes", read_study<MixedNodes>};

} // namespace dss
