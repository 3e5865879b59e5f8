#include "experiments/studies/speedup/scaling.hpp"
#include "experiments/measure/cell_bases.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

/// Element-steps a second of a rank over those of the 1-rank cell, whose problem differs.
void put_weak_efficiency(const StudySamples& samples, const Cell& base, const Cell& cell,
                         Record& row) {
  std::optional<Estimate> efficiency = samples.speedup(base, cell);
  if (!efficiency) return;
  const double elements_a_rank = number_in(samples.of(cell)->last, "elements") / cell.ranks;
  const double growth = elements_a_rank / number_in(samples.of(base)->last, "elements");
  efficiency->median *= growth;
  if (efficiency->interval)
    efficiency->interval = {growth * efficiency->interval->low,
                            growth * efficiency->interval->high};
  put_interval(row, "weak_efficiency", *efficiency);
}

/// Time of the strategy that `auto` chose over the time of `auto`: both ran the same. Only where it
/// chose the same one in every repetition.
void put_against_chosen(const CellStudy& study, const StudySamples& samples, const Cell& cell,
                        Record& row) {
  if (cell.halo != "auto") return;
  Cell chosen = cell;
  chosen.halo = row["halo_used"];
  const auto found = std::ranges::find_if(study.cells, [&](const Cell& other) {
    return !other.is_twin && other.key() == chosen.key();
  });
  if (found == study.cells.end()) return;
  if (const auto ratio = samples.speedup(*found, cell)) put_interval(row, "auto_vs_chosen", *ratio);
}

} // namespace

double karp_flatt(double speedup, int ranks) {
  const double share = 1.0 / ranks;
  return (1 / speedup - share) / (1 - share);
}

const std::vector<std::string>& scaling_columns() {
  static const std::vector<std::string> columns = {"speedup_vs_1_rank",
                                                   "speedup_vs_1_rank_low",
                                                   "speedup_vs_1_rank_high",
                                                   "parallel_efficiency",
                                                   "karp_flatt",
                                                   "speedup_vs_threads",
                                                   "speedup_vs_threads_low",
                                                   "speedup_vs_threads_high",
                                                   "auto_vs_chosen",
                                                   "auto_vs_chosen_low",
                                                   "auto_vs_chosen_high",
                                                   "weak_base_set",
                                                   "weak_efficiency",
                                                   "weak_efficiency_low",
                                                   "weak_efficiency_high"};
  return columns;
}

void put_scaling(const CellStudy& study, const StudySamples& samples, const Cell& cell,
                 Record& row) {
  if (cell.ranks == 1) return;
  if (const Cell* base = strong_base(study, cell))
    if (const auto speedup = samples.speedup(*base, cell)) {
      put_interval(row, "speedup_vs_1_rank", *speedup);
      row["parallel_efficiency"] = number_text(speedup->median / cell.ranks);
      row["karp_flatt"] = number_text(karp_flatt(speedup->median, cell.ranks));
    }
  if (const Cell* base = threaded_base(study, cell))
    if (const auto speedup = samples.speedup(*base, cell))
      put_interval(row, "speedup_vs_threads", *speedup);
  put_against_chosen(study, samples, cell, row);
  if (const Cell* base = weak_base(study, cell)) put_weak_efficiency(samples, *base, cell, row);
}

} // namespace dss
