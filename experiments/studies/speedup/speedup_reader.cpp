#include "experiments/measure/cell_reader.hpp"
#include "experiments/studies/speedup/speedup_study.hpp"

namespace dss {
namespace {

void read_paper(const Node& node, SpeedupStudy& study) {
  ObjectNode paper(node);
  study.paper_source = paper.require("source").name();
  for (const Node& item : paper.require("rows").items(1)) {
    ObjectNode row(item);
    study.paper.push_back({row.require("label").name(), row.require("wall_s").positive(),
                           row.positive_or("speedup", 0), row.name_or("set", "")});
    row.finish();
  }
  paper.finish();
}

} // namespace

SpeedupStudy read_speedup(const StudyFile& file, int cores) {
  SpeedupStudy study;
  read_cells(file, {cores, {}, {}, {}}, study);
  if (const auto paper = ObjectNode(file.root).find("paper")) read_paper(*paper, study);
  return study;
}

} // namespace dss
