#include "experiments/measure/cell_plan.hpp"
#include "experiments/base/progress.hpp"
#include "experiments/base/text_table.hpp"

#include <fmt/format.h>

namespace dss {

std::string plan_text(const CellStudy& study, const StudyPaths& paths) {
  std::vector<std::vector<std::string>> rows;
  for (const Cell& cell : study.cells)
    rows.push_back(
        {cell.scene, cell.set_text(), cell.label(), cell.model, cell.precision, cell.integrator,
         fmt::format("{}", cell.steps),
         cell.skipped.empty() ? "" : fmt::format("{}: {}", cell.skipped_status(), cell.skipped)});
  return fmt::format("{} ({}, scale {})\n{}", study.title, study.name, study.scale.name,
                     text_table({"scene", "set", "cell", "model", "precision", "integrator",
                                 "steps", "note"},
                                rows)) +
         fmt::format(
             "{} cells, {} to {} repetitions each, at most about {}.\nTable: {}\nRecords: {}\n",
             study.cells.size(), study.scale.min_repetitions, study.scale.max_repetitions,
             duration_text(study.scale.budget_s), paths.table, paths.raw);
}

} // namespace dss
