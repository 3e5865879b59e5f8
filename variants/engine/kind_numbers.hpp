#pragma once
/// Numbers for the kinds of links or pressures that packs have, so that packs which are alike share
/// their constants.
#include "solver/model/problem.hpp"
#include "variants/engine/lane_numbers.hpp"

#include <array>
#include <compare>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace dss {

/// Kinds of a pack's links across one face (Problem::link_kinds), or of its elements' pressures
/// (Problem::pressure_kinds), whose axis is 0. They count in lanes with a link, or an element.
template <int W>
struct PackKinds {
  int body = 0, axis = 0;
  std::array<std::uint8_t, W> kinds{};
  auto operator<=>(const PackKinds&) const = default;
};

template <int W>
class KindNumbers {
public:
  /// Adds the next kinds.
  void add(const PackKinds<W>& kinds) {
    index_.push_back(numbers_.try_emplace(kinds, int(numbers_.size())).first->second);
  }
  /// After all have been added.
  void finish() {
    kinds_.resize(numbers_.size());
    for (const auto& [kinds, number] : numbers_) kinds_[std::size_t(number)] = kinds;
    numbers_.clear();
  }
  /// Of each that was added, its number.
  const std::vector<int>& index() const { return index_; }
  /// All that differ, by their numbers.
  const std::vector<PackKinds<W>>& kinds() const { return kinds_; }
  std::size_t bytes() const {
    return index_.size() * sizeof(int) + kinds_.size() * sizeof(PackKinds<W>);
  }

private:
  std::map<PackKinds<W>, int> numbers_; ///< until finish()
  std::vector<int> index_;
  std::vector<PackKinds<W>> kinds_;
};

/// The constants of each lane.
/// @tparam Lanes     a struct that begins with numbers of each lane
/// @param members    of an ensemble, one a lane; or one problem
/// @param constants  (body of a member, kind) -> a struct of these numbers
template <class T, class Lanes, int W, class Constants>
Lanes lanes_of(std::span<const Problem* const> members, const PackKinds<W>& pack,
               Constants&& constants) {
  Lanes all{};
  for (std::size_t lane = 0; lane < std::size_t(W); ++lane) {
    const Problem& member = *members[members.size() > 1 ? lane : 0];
    const auto one = constants(member.bodies[std::size_t(pack.body)], pack.kinds[lane]);
    set_lane<T>(all, lane, one, sizeof one / sizeof(T));
  }
  return all;
}

} // namespace dss
