#pragma once
/// The constants of each pack's pressures.
#include "variants/engine/link_table.hpp"

namespace dss {

/// The kinds of pressure (Problem::pressure_kinds) of all packs. Packs with the same kinds share
/// their constants.
template <class T, int W>
class PressureTable {
public:
  /// @param members  as LinkTable
  explicit PressureTable(std::span<const Problem* const> members) : members_(members) {}
  /// Adds the kinds of the next packs.
  /// @param each  as in LinkTable::add_packs
  template <class Each>
  void add_packs(int body, int packs, Each&& each) {
    std::vector<FaceKinds<W>> kinds(std::size_t(packs), FaceKinds<W>{.body = body});
    each([&](std::size_t element, int lane) {
      kinds[std::size_t(lane / W)].kinds[std::size_t(lane % W)] =
          members_.front()->pressure_kinds[element];
    });
    for (const FaceKinds<W>& pack : kinds)
      index_.push_back(numbers_.try_emplace(pack, int(numbers_.size())).first->second);
  }
  /// Makes the constants, after all packs have been added.
  void finish();

  /// Of each pack, the number of its constants.
  const std::vector<int>& index() const { return index_; }
  /// The kinds by their numbers.
  const std::vector<FaceKinds<W>>& kinds() const { return kinds_; }
  /// The constants by the numbers of their kinds. None for devices, which make their own.
  const std::vector<PressureLanes<T>>& lanes() const { return lanes_; }
  std::size_t bytes() const {
    return index_.size() * sizeof(int) + kinds_.size() * sizeof(FaceKinds<W>) +
           lanes_.size() * sizeof(PressureLanes<T>);
  }

private:
  PressureLanes<T> lanes_of(const FaceKinds<W>& pack) const;

  std::span<const Problem* const> members_;
  std::map<FaceKinds<W>, int> numbers_;
  std::vector<int> index_;
  std::vector<FaceKinds<W>> kinds_;
  std::vector<PressureLanes<T>> lanes_;
};

/// The constants of an element of a body, of this kind.
template <class T>
PressureConstants<T> pressure_constants(const Body& body, std::uint8_t kind);

} // namespace dss
