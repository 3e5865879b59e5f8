#include "experiments/studies/study.hpp"
#include "experiments/measure/cell.hpp"
#include "experiments/studies/model_ladder/ladder_study.hpp"
#include "variants/isa/denormals.hpp"

#include <fmt/format.h>

namespace dss {
namespace {

std::string model_ladder_plan(const LadderStudy& study) {
  std::string text;
  for (const LadderScene& scene : study.scenes)
    text += fmt::format("{}: {} {}, auto ends with {}\n", study.name, scene.scene,
                        set_text(scene.set), name(scene.ends_with));
  return text;
}

Table made_model_ladder(const LadderStudy& study, const StudyRun& how) {
  flush_denormals();
  return ladder_table(study, how.note());
}

} // namespace

extern const StudyKind model_ladder_kind;
const StudyKind model_ladder_kind{
    "model_ladder",
    read_study<TableStudy<read_ladder, model_ladder_plan, made_model_ladder, ladder_text>>};

} // namespace dss
