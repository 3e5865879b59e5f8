#include "experiments/runner/scaling.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

const Cell* strong_base(const Study& study, const Cell& cell) {
  return one_rank_cell(study, cell, cell.variant, cell.threads, cell.set_text());
}

const Cell* weak_base(const Study& study, const Cell& cell) {
  return cell.weak_base_set.empty() ? nullptr
                                    : one_rank_cell(study, cell, cell.variant, cell.threads, cell.weak_base_set);
}

/// One process with as many threads as the cell has workers: the same cores, without messages.
const Cell* threaded_base(const Study& study, const Cell& cell) {
  return one_rank_cell(study, cell, cell.variant, cell.ranks * cell.threads, cell.set_text());
}

/// Element-steps a second of a rank over those of the 1-rank cell, whose problem differs.
void put_weak_efficiency(const StudySamples& samples, const Cell& base, const Cell& cell, Record& row) {
  std::optional<Estimate> efficiency = samples.speedup(base, cell);
  if (!efficiency) return;
  const double elements_a_rank = number_in(samples.of(cell)->last, "elements") / cell.ranks;
  const double growth = elements_a_rank / number_in(samples.of(base)->last, "elements");
  efficiency->median *= growth;
  if (efficiency->interval)
    efficiency->interval = {growth * efficiency->interval->low, growth * efficiency->interval->high};
  put_interval(row, "weak_efficiency", *efficiency);
}

} // namespace

const Cell* one_rank_cell(const Study& study, const Cell& like, const std::string& variant, int threads,
                          const std::string& set_text) {
  const auto found = std::find_if(study.cells.begin(), study.cells.end(), [&](const Cell& cell) {
    return cell.ranks == 1 && !cell.is_twin && cell.variant == variant && cell.threads == threads &&
           (variant != like.variant || (cell.device == like.device && cell.hybrid == like.hybrid)) &&
           cell.scene == like.scene && cell.set_text() == set_text && cell.model == like.model &&
           cell.precision == like.precision && cell.integrator == like.integrator;
  });
  return found == study.cells.end() ? nullptr : &*found;
}

bool is_scaling_base(const Study& study, const Cell& cell) {
  return std::any_of(study.cells.begin(), study.cells.end(), [&](const Cell& other) {
    return other.ranks > 1 && (strong_base(study, other) == &cell || weak_base(study, other) == &cell ||
                               threaded_base(study, other) == &cell);
  });
}

double karp_flatt(double speedup, int ranks) {
  const double share = 1.0 / ranks;
  return (1 / speedup - share) / (1 - share);
}

const std::vector<std::string>& scaling_columns() {
  static const std::vector<std::string> columns = {
      "speedup_vs_1_rank", "speedup_vs_1_rank_low", "speedup_vs_1_rank_high", "parallel_efficiency",
      "karp_flatt",        "speedup_vs_threads",    "speedup_vs_threads_low", "speedup_vs_threads_high",
      "weak_base_set",     "weak_efficiency",       "weak_efficiency_low",    "weak_efficiency_high"};
  return columns;
}

void put_scaling(const Study& study, const StudySamples& samples, const Cell& cell, Record& row) {
  if (cell.ranks == 1) return;
  if (const Cell* base = strong_base(study, cell))
    if (const auto speedup = samples.speedup(*base, cell)) {
      put_interval(row, "speedup_vs_1_rank", *speedup);
      row["parallel_efficiency"] = number_text(speedup->median / cell.ranks);
      row["karp_flatt"] = number_text(karp_flatt(speedup->median, cell.ranks));
    }
  if (const Cell* base = threaded_base(study, cell))
    if (const auto speedup = samples.speedup(*base, cell)) put_interval(row, "speedup_vs_threads", *speedup);
  if (const Cell* base = weak_base(study, cell)) put_weak_efficiency(samples, *base, cell, row);
}

} // namespace dss
