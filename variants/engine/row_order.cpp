#include "variants/engine/row_order.hpp"

#include <algorithm>
#include <cstdlib>

namespace dss {

RowOrder::RowOrder(const Lattice& lattice, std::span<const LinkedRows> extra)
    : groups_(body_groups(lattice, {0, int(lattice.rows.size())}, extra, false)),
      places_(lattice.rows.size()) {
  for (const BodyGroup& group : groups_)
    for (int k = 0; k < group.planes(); ++k)
      for (const BodyGroup::Member& member : group.members())
        for (int c = 0; c < member.planes.across; ++c)
          if (const int row = member.planes.row(k - member.shift, c); row >= 0) {
            places_[std::size_t(row)] = int(rows_.size());
            rows_.push_back(row);
          }
}

int RowOrder::halo(const Lattice& lattice, std::span<const LinkedRows> extra) const {
  int most = 0;
  const auto add = [&](int a, int b) {
    if (a >= 0 && b >= 0) most = std::max(most, std::abs(place(a) - place(b)));
  };
  for (int r = 0; r < int(lattice.rows.size()); ++r)
    for (const int axis : {0, 1, 2}) add(r, lattice.rows[std::size_t(r)].upper(axis));
  for (const LinkedRows& link : extra) add(link.i, link.j);
  return std::max(most, 1);
}

} // namespace dss
