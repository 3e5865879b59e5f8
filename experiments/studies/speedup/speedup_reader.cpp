#include "experiments/measure/cell_reader.hpp"
#include "experiments/studies/speedup/speedup_study.hpp"

namespace dss {
namespace {

void read_paper(const JsonPlace& place, SpeedupStudy& study) {
  place.require_keys({"source", "rows"});
  study.paper_source = place["source"].text();
  for (const JsonPlace& row : place["rows"].items()) {
    row.require_keys({"label", "set", "wall_s", "speedup"});
    study.paper.push_back({row["label"].text(), row["wall_s"].positive(),
                           row.has("speedup") ? row["speedup"].positive() : 0,
                           row.has("set") ? row["set"].text() : ""});
  }
}

} // namespace

SpeedupStudy read_speedup(const StudyFile& file, int cores) {
  SpeedupStudy study;
  read_cells(file, {cores, {}, {}, {}}, study);
  if (file.root.has("paper")) read_paper(file.root["paper"], study);
  return study;
}

} // namespace dss
