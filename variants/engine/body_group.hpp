#pragma once
/// Bodies whose rows a pass goes through together, plane by plane.
#include "solver/lattice/lattice.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace dss {

/// The rows that a sweep computes: places [begin, end) of an order of rows (row_order.hpp).
struct SweepRows {
  int begin, end;
  bool has(int place) const { return place >= begin && place < end; }
};

/// The rows of an extra link's two elements.
struct LinkedRows {
  int i, j;
};

/// The direction in which planes of rows follow one another.
enum class PlaneDirection : std::uint8_t { longer, row_order, y, z };

/// Rows of one body by their places: along the direction of the sweeps, and across it. Across, the
/// pieces of cut rows follow one another.
class BodyPlanes {
public:
  BodyPlanes(const Lattice& lattice, SweepRows rows, PlaneDirection direction);
  /// @return -1 if there is no such row
  int row(int s, int c) const {
    return s < 0 || s >= along || c < 0 || c >= across ? -1 : rows_[place(s, c)];
  }
  /// The plane that a row of the body belongs to.
  int plane_of(const Row& row) const { return is_along_y_ ? row.y - least_y_ : row.z - least_z_; }
  int along = 0, across = 0;
  int first_piece = 0; ///< of cut rows: the number of the first across

private:
  std::size_t place(int s, int c) const {
    return std::size_t(s) * std::size_t(across) + std::size_t(c);
  }
  bool is_along_y_ = false;
  int least_y_ = 0, least_z_ = 0;
  std::vector<int> rows_;
};

/// Bodies that extra links join, shifted against one another so that linked rows are in planes
/// close to one another. One body without extra links is a group, too.
class BodyGroup {
public:
  /// @param bodies  rows of each; extra links join all of them
  /// @param extra   extra links between rows of these bodies
  BodyGroup(const Lattice& lattice, std::span<const SweepRows> bodies,
            std::span<const LinkedRows> extra, PlaneDirection direction);
  struct Member {
    BodyPlanes planes;
    int shift; ///< number of the group's plane that has the body's first
  };
  const std::vector<Member>& members() const { return members_; }
  bool is_linked() const { return is_linked_; }
  int planes() const { return planes_; }
  /// Planes from a sweep to the next: one, or with extra links one more than the longest of them.
  int lag() const { return lag_; }
  /// Rows between a sweep and the next, at most.
  int rows_behind() const;

private:
  void shift_bodies(const std::vector<std::vector<LinkedRows>>& links_of);
  int member_of(const Row& row) const { return member_of_[std::size_t(row.body - first_body_)]; }
  const Row& at(int row) const { return lattice_->rows[std::size_t(row)]; }
  int plane_of(int row) const {
    const Member& member = members_[std::size_t(member_of(at(row)))];
    return member.shift + member.planes.plane_of(at(row));
  }

  const Lattice* lattice_;
  int first_body_ = 0;
  std::vector<int> member_of_; ///< from a body's number less the first one's; -1: not here
  std::vector<Member> members_;
  bool is_linked_ = false;
  int planes_ = 0, lag_ = 1;
};

/// The groups of all bodies that have rows here. Each takes the direction with the fewest rows
/// from a sweep to the next.
std::vector<BodyGroup> body_groups(const Lattice& lattice, SweepRows rows,
                                   std::span<const LinkedRows> extra, bool is_in_row_order);

} // namespace dss
