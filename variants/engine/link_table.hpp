#pragma once
/// Which constants the links of each pack have, if the links of a body differ.
#include "kernels/stage_row/row.hpp"
#include "variants/engine/kind_numbers.hpp"

namespace dss {

/// The kinds of all packs.
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
    std::vector<std::array<PackKinds<W>, faces>> kinds{std::size_t(packs)};
    for (auto& pack : kinds)
      for (std::size_t face = 0; face < faces; ++face)
        pack[face].body = body, pack[face].axis = int(face % 3);
    each([&](std::size_t element, int lane) {
      for (std::size_t face = 0; face < faces; ++face)
        kinds[std::size_t(lane / W)][face].kinds[std::size_t(lane % W)] =
            face < 3 ? members_.front()->link_kinds[element][face] : lower_[element][face - 3];
    });
    for (const auto& pack : kinds)
      for (const PackKinds<W>& face : pack) numbers_.add(face);
  }
  /// Makes the constants, after all packs have been added.
  void finish();

  /// Of each face of each pack, the number of its kinds; empty if is_mixed() is false.
  const std::vector<int>& index() const { return numbers_.index(); }
  /// The kinds by their numbers.
  const std::vector<PackKinds<W>>& kinds() const { return numbers_.kinds(); }
  /// The constants by the numbers of their kinds. If is_mixed() is false, three for each body. None
  /// for devices, which make their own.
  const std::vector<LinkLanes<T>>& lanes() const { return lanes_; }
  std::size_t bytes() const { return numbers_.bytes() + lanes_.size() * sizeof(LinkLanes<T>); }

private:
  std::span<const Problem* const> members_;
  std::vector<std::array<std::uint8_t, 3>> lower_; ///< of devices: of each element's lower links
  KindNumbers<W> numbers_;
  std::vector<LinkLanes<T>> lanes_;
};

} // namespace dss
