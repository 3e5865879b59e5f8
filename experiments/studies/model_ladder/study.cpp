#include "experiments/studies/study.hpp"
#include "experiments/measure/cell.hpp"
#include "experiments/studies/model_ladder/ladder_study.hpp"
#include "variants/isa/denormals.hpp"

#include <fmt/format.h>

namespace dss {
namespace {

class ModelLadder : public Study {
public:
  explicit ModelLadder(const StudyFile& file) : study_(read_ladder(file)) {}

  std::string plan(const StudyPaths&) const override {
    std::string text;
    for (const LadderScene& scene : study_.scenes)
      text += fmt::format("{}: {} {}, auto ends with {}\n", study_.name, scene.scene,
                          set_text(scene.set), name(scene.ends_with));
    return text;
  }

  StudyResult run(const StudyRun& how) override {
    flush_denormals();
    const Table table = ladder_table(study_, how.note());
    return result_of(study_.name, table, ladder_text(study_, table));
  }

private:
  const LadderStudy study_;
};

} // namespace

extern const StudyKind model_ladder_kind;
const StudyKind model_ladder_kind{"model_ladder", read_study<ModelLadder>};

} // namespace dss
