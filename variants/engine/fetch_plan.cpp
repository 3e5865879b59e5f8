#include "variants/engine/fetch_plan.hpp"

#include "variants/engine/buffer.hpp"

#include <utility>

namespace dss {

FetchPlan::FetchPlan(std::vector<Task> tasks) : tasks_(std::move(tasks)), fetches_(tasks_.size()) {
  start_.push_back(0);
  for (const Task& task : tasks_) start_.push_back(start_.back() + task.packs);
}

void FetchPlan::first_read(std::size_t task, const void* row, std::size_t bytes) {
  const char* const begin = static_cast<const char*>(row);
  const long packs = tasks_[task].packs;
  if (packs >= least_own_packs && fetches_[task].row == nullptr) {
    put(task, begin + std::size_t(lead) * (bytes / std::size_t(packs)), bytes);
    return;
  }
  for (const bool is_any_sweep : {false, true})
    for (std::size_t n = task; n-- > 0;) {
      const long ahead = start_[task] - start_[n];
      if (ahead > most_lead) break;
      if (ahead < lead || tasks_[n].packs == 0 || fetches_[n].row != nullptr) continue;
      if (!is_any_sweep && tasks_[n].sweep != tasks_[task].sweep) continue;
      put(n, begin, bytes);
      return;
    }
}

void FetchPlan::put(std::size_t task, const char* row, std::size_t bytes) {
  const std::size_t lines = (bytes + Memory::line - 1) / Memory::line,
                    packs = std::size_t(tasks_[task].packs);
  fetches_[task] = {row, int((lines + packs - 1) / packs)};
}

} // namespace dss
