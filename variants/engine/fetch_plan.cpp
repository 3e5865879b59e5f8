#include "variants/engine/fetch_plan.hpp"

#include "variants/engine/buffer.hpp"

#include <utility>

namespace dss {

FetchPlan::FetchPlan(std::vector<long> tasks, int shares)
    : tasks_(std::move(tasks)), shares_(std::size_t(shares)), fetches_(tasks_.size()) {
  start_.push_back(0);
  for (const long packs : tasks_) start_.push_back(start_.back() + packs);
}

void FetchPlan::first_read(std::size_t task, const void* row, std::size_t bytes) {
  const char* const begin = static_cast<const char*>(row);
  const long packs = tasks_[task];
  std::vector<std::size_t> fetching;
  for (std::size_t n = task; n-- > 0 && fetching.size() < shares_;) {
    const long ahead = start_[task] - start_[n], other = tasks_[n];
    if (ahead > most_lead) break;
    if (ahead < lead || other == 0 || fetches_[n].row != nullptr) continue;
    const bool is_similar = other <= most_ratio * packs && packs <= most_ratio * other;
    if (packs == 0 || is_similar) fetching.push_back(n);
  }
  if (fetching.empty() && packs >= least_own_packs && fetches_[task].row == nullptr)
    put(task, begin + std::size_t(lead) * (bytes / std::size_t(packs)), bytes);
  const std::size_t lines = (bytes + Memory::line - 1) / Memory::line;
  for (std::size_t k = 0; k < fetching.size(); ++k) {
    const std::size_t from = lines * k / fetching.size(), to = lines * (k + 1) / fetching.size();
    if (from < to) put(fetching[k], begin + from * Memory::line, (to - from) * Memory::line);
  }
}

void FetchPlan::put(std::size_t task, const char* row, std::size_t bytes) {
  const std::size_t lines = (bytes + Memory::line - 1) / Memory::line,
                    packs = std::size_t(tasks_[task]);
  fetches_[task] = {row, int((lines + packs - 1) / packs)};
}

} // namespace dss
