#pragma once
/// The order of rows in which sweeps go through them, and blocks divide them.
#include "variants/engine/body_group.hpp"

namespace dss {

/// Each row has a place in the order. Blocks of rows are ranges of places.
class RowOrder {
public:
  /// By the rows' numbers, as ranks and devices divide them.
  RowOrder() = default;
  /// By the planes of sweeps. So blocks follow one another in the direction of the sweeps, also
  /// where bodies are long in y, or extra links join them side by side.
  RowOrder(const Lattice& lattice, std::span<const LinkedRows> extra);
  bool is_by_number() const { return places_.empty(); }
  int place(int row) const { return is_by_number() ? row : places_[std::size_t(row)]; }
  int row(int place) const { return is_by_number() ? place : rows_[std::size_t(place)]; }
  /// The largest distance of two linked rows [places].
  int halo(const Lattice& lattice, std::span<const LinkedRows> extra) const;
  /// The groups whose planes the order follows, unless it is by number.
  std::span<const BodyGroup> groups() const { return groups_; }

private:
  std::vector<BodyGroup> groups_;
  std::vector<int> places_, rows_;
};

enum class SeamKind : std::uint8_t {
  /// Each block computes all that its rows need in a pass, and waits for nobody before its end:
  /// for devices, whose blocks cannot wait for one another.
  recomputed,
  /// Each row is computed once in each sweep. A block reads what its neighbours left.
  handed_over
};

/// How blocks divide the rows.
struct RowDivision {
  RowOrder order;
  int halo = 1; ///< largest distance of two linked rows [places]
  SeamKind seams = SeamKind::recomputed;
  std::vector<int> cuts; ///< place of the first row of each block, then the end of the last
  int blocks() const { return int(cuts.size()) - 1; }
};

} // namespace dss
