#include "experiments/measure/cell_reader.hpp"
#include "experiments/studies/work_precision/precision_cells.hpp"
#include "experiments/studies/work_precision/precision_study.hpp"

namespace dss {

PrecisionStudy read_precision(const StudyFile& file, int cores) {
  PrecisionStudy study;
  study.rules = read_precision_rules(file.root["work_precision"]);
  const JsonPlace& scale = file.scale;
  if (scale.has("shorten")) study.precision_scale.shorten = scale["shorten"].positive();
  if (scale.has("repeat_for")) study.precision_scale.repeat_for = scale["repeat_for"].positive();
  if (scale.has("halvings")) study.precision_scale.halvings = scale["halvings"].whole_numbers();
  const auto expand = [&](const JsonPlace& block, const std::vector<Cell>& cells) {
    return with_steps(block["accuracy"], cells, study);
  };
  read_cells(file, {cores, {"accuracy"}, {"shorten", "repeat_for", "halvings"}, expand}, study);
  return study;
}

} // namespace dss
