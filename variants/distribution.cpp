#include "variants/distribution.hpp"

#include <algorithm>
#include <array>

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
  const auto found = std::find_if(all.begin(), all.end(), [&](const HaloStrategy& s) { return s.name == name; });
  return found == all.end() ? nullptr : &*found;
}

} // namespace dss
