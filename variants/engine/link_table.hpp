#pragma once
/// Which constants the links of each pack have, if the links of a body differ.
#include "kernels/stage_row/row.hpp"
#include "solver/model/problem.hpp"

#include <array>
#include <compare>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace dss {

/// Kinds of a pack's links across one face (Problem::link_kinds). They count in lanes with a link.
template <int W>
struct FaceKinds {
  int body = 0, axis = 0;
  std::array<std::uint8_t, W> kinds{};
  auto operator<=>(const FaceKinds&) const = default;
};

/// The kinds of all packs. Faces with the same kinds share their constants.
template <class T, int W>
class LinkTable {
public:
  /// Faces of a pack: the upper ones across x, y, z. For devices the lower ones follow, because
  /// GPUs compute each link at both ends.
  static constexpr std::size_t faces = W == simd::lanes<T> ? 3 : 6;
  /// @param members  of an ensemble, or one problem; all have the same kinds
  explicit LinkTable(std::span<const Problem* const> members);
  bool is_mixed() const { return !members_.front()->link_kinds.empty(); }
  /// Adds the kinds of the next packs.
  /// @param each  calls its argument with (element of a member, its lane counted from the first of
  ///     these packs)
  template <class Each>
  void add_packs(int body, int packs, Each&& each) {
    std::vector<std::array<FaceKinds<W>, faces>> kinds{std::size_t(packs)};
    for (auto& pack : kinds)
      for (std::size_t face = 0; face < faces; ++face)
        pack[face].body = body, pack[face].axis = int(face % 3);
    each([&](std::size_t element, int lane) {
      for (std::size_t face = 0; face < faces; ++face)
        kinds[std::size_t(lane / W)][face].kinds[std::size_t(lane % W)] =
            face < 3 ? members_.front()->link_kinds[element][face] : lower_[element][face - 3];
    });
    for (const auto& pack : kinds)
      for (const FaceKinds<W>& face : pack)
        index_.push_back(numbers_.try_emplace(face, int(numbers_.size())).first->second);
  }
  /// Makes the constants, after all packs have been added.
  void finish();

  /// Of each face of each pack, the number of its kinds; empty if is_mixed() is false.
  const std::vector<int>& index() const { return index_; }
  /// The kinds by their numbers.
  const std::vector<FaceKinds<W>>& kinds() const { return kinds_; }
  /// The constants by the numbers of their kinds. If is_mixed() is false, three for each body. None
  /// for devices, which make their own.
  const std::vector<LinkLanes<T>>& lanes() const { return lanes_; }
  std::size_t bytes() const {
    return index_.size() * sizeof(int) + kinds_.size() * sizeof(FaceKinds<W>) +
           lanes_.size() * sizeof(LinkLanes<T>);
  }

private:
  LinkLanes<T> lanes_of(const FaceKinds<W>& face) const;

  std::span<const Problem* const> members_;
  std::vector<std::array<std::uint8_t, 3>> lower_; ///< of devices: of each element's lower links
  std::map<FaceKinds<W>, int> numbers_;
  std::vector<int> index_;
  std::vector<FaceKinds<W>> kinds_;
  std::vector<LinkLanes<T>> lanes_;
};

} // namespace dss
