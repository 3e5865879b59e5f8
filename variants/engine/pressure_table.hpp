#pragma once
/// The constants of each pack's pressures.
#include "kernels/stage_row/row.hpp"
#include "variants/engine/kind_numbers.hpp"

namespace dss {

/// The kinds of pressure of all packs.
template <class T, int W>
class PressureTable {
public:
  /// @param members  as LinkTable
  explicit PressureTable(std::span<const Problem* const> members) : members_(members) {}
  /// Adds the kinds of the next packs.
  /// @param each  as in LinkTable::add_packs
  template <class Each>
  void add_packs(int body, int packs, Each&& each) {
    std::vector<PackKinds<W>> kinds(std::size_t(packs), PackKinds<W>{.body = body});
    each([&](std::size_t element, int lane) {
      kinds[std::size_t(lane / W)].kinds[std::size_t(lane % W)] =
          members_.front()->pressure_kinds[element];
    });
    for (const PackKinds<W>& pack : kinds) numbers_.add(pack);
  }
  /// Makes the constants, after all packs have been added.
  void finish();

  /// Of each pack, the number of its kinds.
  const std::vector<int>& index() const { return numbers_.index(); }
  /// The kinds by their numbers.
  const std::vector<PackKinds<W>>& kinds() const { return numbers_.kinds(); }
  /// The constants by the numbers of their kinds. None for devices, which make their own.
  const std::vector<PressureLanes<T>>& lanes() const { return lanes_; }
  std::size_t bytes() const { return numbers_.bytes() + lanes_.size() * sizeof(PressureLanes<T>); }

private:
  std::span<const Problem* const> members_;
  KindNumbers<W> numbers_;
  std::vector<PressureLanes<T>> lanes_;
};

/// The constants of an element of a body, of this kind.
template <class T>
PressureConstants<T> pressure_constants(const Body& body, std::uint8_t kind);

} // namespace dss
