#include "variants/api/distribution.hpp"

#include "solver/error.hpp"
#include "solver/nearest_name.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <vector>

namespace dss {

std::span<const HaloStrategy> halo_strategies() {
  using Transport = HaloStrategy::Transport;
  static constexpr std::array strategies{
      HaloStrategy{"sendrecv", true, false, Transport::sendrecv,
                   "the paper's: MPI_Sendrecv with indexed datatypes after every stage"},
      HaloStrategy{"overlap", true, true, Transport::messages,
                   "persistent messages after every stage, behind the rows that need no halo"},
      HaloStrategy{"deep", false, false, Transport::messages,
                   "persistent messages once a step; the halo is as deep as the method has stages"},
      HaloStrategy{"deep-overlap", false, true, Transport::messages,
                   "as deep; the edges of a part are computed and sent first"},
      HaloStrategy{"shared", false, false, Transport::shared,
                   "as deep, through memory that the ranks of a node share"}};
  return strategies;
}

const HaloStrategy* find_halo_strategy(std::string_view name) {
  const auto all = halo_strategies();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const HaloStrategy& s) { return s.name == name; });
  return found == all.end() ? nullptr : &*found;
}

const HaloStrategy& asked_halo_strategy(const std::string& name, int threads) {
  const HaloStrategy* const found = find_halo_strategy(name);
  if (found == nullptr) {
    std::vector<std::string> known{"auto"};
    for (const HaloStrategy& strategy : halo_strategies()) known.emplace_back(strategy.name);
    throw InputError(
        fmt::format("--halo {}: unknown strategy; {}", name, nearest_name(name, known)));
  }
  if (!found->is_possible(threads))
    throw InputError(
        fmt::format("--halo {}: needs --threads 1 on each rank; give --halo deep", name));
  return *found;
}

} // namespace dss
