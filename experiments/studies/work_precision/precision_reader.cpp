#include "experiments/measure/cell_reader.hpp"
#include "experiments/studies/work_precision/precision_cells.hpp"
#include "experiments/studies/work_precision/precision_study.hpp"

namespace dss {

PrecisionStudy read_precision(const StudyFile& file, int cores) {
  PrecisionStudy study;
  study.rules = read_precision_rules(file.part("work_precision"));
  ObjectNode scale(file.scale);
  PrecisionScale& own = study.precision_scale;
  own.shorten = scale.positive_or("shorten", own.shorten);
  own.repeat_for = scale.positive_or("repeat_for", own.repeat_for);
  if (const auto halvings = scale.find("halvings")) own.halvings = read_halvings(*halvings);
  const auto expand = [&](ObjectNode& block, const std::vector<Cell>& cells) {
    return with_steps(block.require("accuracy"), cells, study);
  };
  read_cells(file, {cores, {"accuracy"}, {"shorten", "repeat_for", "halvings"}, expand}, study);
  return study;
}

} // namespace dss
