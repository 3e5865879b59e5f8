#include "experiments/measure/study_samples.hpp"

namespace dss {
namespace {

/// Group of cells whose states must have the same bits: all variants with FMA on one problem, and
/// each variant without FMA for itself. Threads, ranks, halo strategies and decompositions change
/// no bit.
std::string digest_group(const Cell& cell, const Record& record) {
  return cell.problem_key() + " " + (text_in(record, "has_fma") == "true" ? "FMA" : cell.variant);
}

} // namespace

std::vector<Record> records_of_scale(const CellStudy& study, const std::vector<Record>& records) {
  std::vector<Record> own;
  for (const Record& record : records)
    if (text_in(record, "scale") == study.scale.name) own.push_back(record);
  return own;
}

StudySamples::StudySamples(const CellStudy& study, const std::vector<Record>& records)
    : samples_(samples_of(records)) {
  for (const CellSample& sample : samples_) by_key_[sample.key] = &sample;
  std::map<std::string, std::set<std::string>> digests;
  for (const Cell& cell : study.cells)
    if (const CellSample* sample = of(cell))
      for (const auto& [number, record] : sample->repetitions)
        digests[digest_group(cell, record)].insert(text_in(record, "state_digest"));
  for (const auto& [group, found] : digests)
    if (found.size() > 1) unequal_.insert(group);
}

const CellSample* StudySamples::of(const Cell& cell) const {
  const auto found = by_key_.find(cell.key());
  return found == by_key_.end() ? nullptr : found->second;
}

bool StudySamples::is_unequal(const Cell& cell) const {
  const CellSample* sample = of(cell);
  return sample != nullptr && !sample->is_empty() &&
         unequal_.contains(digest_group(cell, sample->repetitions.begin()->second));
}

bool StudySamples::is_comparable(const Cell& cell) const {
  const CellSample* sample = of(cell);
  return sample != nullptr && !sample->is_empty() && sample->check() == "passed" &&
         text_in(sample->last, "status") == "ok" && !is_unequal(cell) &&
         !sample->is_oversubscribed();
}

std::optional<Estimate> StudySamples::speedup(const Cell& base, const Cell& cell) const {
  if (!is_comparable(base) || !is_comparable(cell)) return {};
  const std::vector<double> ratios = paired_ratios(*of(base), *of(cell));
  if (ratios.size() < interval_samples) return {};
  return estimate(ratios);
}

} // namespace dss
