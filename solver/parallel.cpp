#include "solver/parallel.hpp"

#include "solver/cores.hpp"

#include <algorithm>
#include <thread>
#include <vector>

namespace dss {

void for_each_on_all_cores(std::size_t count, const std::function<void(std::size_t)>& work) {
  const Turns::Work any_thread = [&](std::size_t n, std::size_t) { work(n); };
  Turns turns(count, any_thread);
  {
    std::vector<std::jthread> team; // joined at the end of the block
    const auto cores = std::size_t(usable_cores());
    for (std::size_t t = 1; t < std::min(cores, count); ++t)
      team.emplace_back([&turns, t] { turns.take(t); });
    turns.take(0);
  }
  turns.rethrow();
}

} // namespace dss
