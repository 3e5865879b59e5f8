#include "experiments/measure/cell_bases.hpp"

#include <algorithm>

namespace dss {

const Cell* one_rank_cell(const CellStudy& study, const Cell& like, const std::string& variant,
                          int threads, const std::string& set_text) {
  const auto found = std::find_if(study.cells.begin(), study.cells.end(), [&](const Cell& cell) {
    return cell.ranks == 1 && !cell.is_twin && !cell.is_whole_once && cell.variant == variant &&
           cell.threads == threads &&
           (variant != like.variant ||
            (cell.device == like.device && cell.hybrid == like.hybrid)) &&
           cell.scene == like.scene && cell.set_text() == set_text && cell.model == like.model &&
           cell.precision == like.precision && cell.integrator == like.integrator;
  });
  return found == study.cells.end() ? nullptr : &*found;
}

const Cell* strong_base(const CellStudy& study, const Cell& cell) {
  return one_rank_cell(study, cell, cell.variant, cell.threads, cell.set_text());
}

const Cell* weak_base(const CellStudy& study, const Cell& cell) {
  return cell.weak_base_set.empty()
             ? nullptr
             : one_rank_cell(study, cell, cell.variant, cell.threads, cell.weak_base_set);
}

const Cell* threaded_base(const CellStudy& study, const Cell& cell) {
  return one_rank_cell(study, cell, cell.variant, cell.ranks * cell.threads, cell.set_text());
}

bool is_scaling_base(const CellStudy& study, const Cell& cell) {
  return std::any_of(study.cells.begin(), study.cells.end(), [&](const Cell& other) {
    return other.ranks > 1 &&
           (strong_base(study, other) == &cell || weak_base(study, other) == &cell ||
            threaded_base(study, other) == &cell);
  });
}

/// True if the study has a second cell like this one.
static bool has_twin(const CellStudy& study, const Cell& cell) {
  Cell twin = cell;
  twin.is_twin = true;
  return std::ranges::any_of(study.cells,
                             [&](const Cell& other) { return other.key() == twin.key(); });
}

bool is_partner(const CellStudy& study, const Cell& cell) {
  const bool is_base = std::ranges::find(study.bases, cell.variant) != study.bases.end();
  return has_twin(study, cell) || (is_base && cell.threads == 1 && cell.ranks == 1) ||
         is_scaling_base(study, cell);
}

} // namespace dss
