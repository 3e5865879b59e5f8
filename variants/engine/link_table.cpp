#include "variants/engine/link_table.hpp"

#include "solver/model/link_constants.hpp"
#include "variants/engine/lane_numbers.hpp"
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
LinkLanes<T> LinkTable<T, W>::lanes_of(const FaceKinds<W>& face) const {
  LinkLanes<T> all{};
  for (std::size_t lane = 0; lane < std::size_t(simd::lanes<T>); ++lane) {
    const Problem& member = *members_[members_.size() > 1 ? lane : 0];
    const Body& body = member.bodies[std::size_t(face.body)];
    LinkConstants<T> one{};
    set_material_constants(one, body.link(face.axis, face.kinds[lane]), face.axis);
    set_lane<T>(all, lane, one, sizeof one / sizeof(T));
  }
  return all;
}

template <class T, int W>
void LinkTable<T, W>::finish() {
  kinds_.resize(numbers_.size());
  for (const auto& [face, number] : numbers_) kinds_[std::size_t(number)] = face;
  numbers_.clear();
  lower_ = {};
  if constexpr (W == simd::lanes<T>) {
    if (!is_mixed())
      for (std::size_t b = 0; b < members_.front()->bodies.size(); ++b)
        for (const int axis : {0, 1, 2}) lanes_.push_back(lanes_of({int(b), axis, {}}));
    for (const FaceKinds<W>& face : kinds_) lanes_.push_back(lanes_of(face));
  }
}

#define DSS_INSTANTIATE(T, W) template class LinkTable<T, W>;
DSS_EACH_PACK(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE

} // namespace dss
