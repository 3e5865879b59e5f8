#include "variants/engine/link_table.hpp"

#include "solver/model/link_constants.hpp"
#include "variants/engine/packs.hpp"

namespace dss {

template <class T, int W>
LinkTable<T, W>::LinkTable(std::span<const Problem* const> members) : members_(members) {
  if (!is_mixed() || faces == 3) return;
  const Problem& problem = *members_.front();
  lower_.resize(problem.link_kinds.size());
  problem.lattice.for_each_link([&](std::size_t i, std::size_t j, int axis) {
    const auto a = std::size_t(axis);
    lower_[j][a] = problem.link_kinds[i][a];
  });
}

template <class T, int W>
void LinkTable<T, W>::finish() {
  numbers_.finish();
  lower_ = {};
  if constexpr (W == simd::lanes<T>) {
    const auto add_lanes = [&](const PackKinds<W>& face) {
      lanes_.push_back(
          lanes_of<T, LinkLanes<T>>(members_, face, [&](const Body& body, std::uint8_t kind) {
            LinkConstants<T> link{};
            set_material_constants(link, body.link(face.axis, kind), face.axis);
            return link;
          }));
    };
    if (!is_mixed())
      for (std::size_t b = 0; b < members_.front()->bodies.size(); ++b)
        for (const int axis : {0, 1, 2}) add_lanes({int(b), axis, {}});
    for (const PackKinds<W>& face : kinds()) add_lanes(face);
  }
}

#define DSS_INSTANTIATE(T, W) template class LinkTable<T, W>;
DSS_EACH_PACK(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE

} // namespace dss
