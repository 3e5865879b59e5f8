#include "variants/engine/body_group.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <numeric>

namespace dss {
namespace {

/// The rows of each body, in order.
std::vector<SweepRows> bodies_of(const Lattice& lattice, SweepRows all) {
  std::vector<SweepRows> bodies;
  for (int begin = all.begin, end = begin; begin < all.end; begin = end) {
    const int body = lattice.rows[std::size_t(begin)].body;
    while (end < all.end && lattice.rows[std::size_t(end)].body == body) ++end;
    bodies.push_back({begin, end});
  }
  return bodies;
}

/// Sets of numbers that are joined pair by pair.
class JoinedSets {
public:
  explicit JoinedSets(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  /// The least number of the set that n is in.
  int first_of(int n) {
    for (int* parent = &parent_[std::size_t(n)]; *parent != n; parent = &parent_[std::size_t(n)])
      n = *parent = parent_[std::size_t(*parent)]; // halves the path
    return n;
  }
  void join(int a, int b) {
    a = first_of(a), b = first_of(b);
    parent_[std::size_t(std::max(a, b))] = std::min(a, b);
  }

private:
  std::vector<int> parent_;
};

} // namespace

BodyPlanes::BodyPlanes(const Lattice& lattice, SweepRows rows, PlaneDirection direction) {
  constexpr int lowest = std::numeric_limits<int>::min(), highest = std::numeric_limits<int>::max();
  least_y_ = least_z_ = first_piece = highest;
  int most_y = lowest, most_z = lowest, most_piece = lowest;
  const auto piece_of = [&](const Row& row) { return lattice.piece_of(row.x_begin); };
  for (int r = rows.begin; r < rows.end; ++r) {
    const Row& row = lattice.rows[std::size_t(r)];
    least_y_ = std::min(least_y_, row.y), most_y = std::max(most_y, row.y);
    least_z_ = std::min(least_z_, row.z), most_z = std::max(most_z, row.z);
    first_piece = std::min(first_piece, piece_of(row));
    most_piece = std::max(most_piece, piece_of(row));
  }
  const int pieces = most_piece - first_piece + 1;
  const int size_y = most_y - least_y_ + 1, size_z = most_z - least_z_ + 1;
  is_along_y_ = direction == PlaneDirection::longer      ? size_y > size_z
                : direction == PlaneDirection::row_order ? size_z == 1
                                                         : direction == PlaneDirection::y;
  along = is_along_y_ ? size_y : size_z;
  across = (is_along_y_ ? size_z : size_y) * pieces;
  rows_.assign(std::size_t(along) * std::size_t(across), -1);
  for (int r = rows.begin; r < rows.end; ++r) {
    const Row& row = lattice.rows[std::size_t(r)];
    const int layer = is_along_y_ ? row.z - least_z_ : row.y - least_y_;
    rows_[place(plane_of(row), layer * pieces + piece_of(row) - first_piece)] = r;
  }
}

BodyGroup::BodyGroup(const Lattice& lattice, std::span<const SweepRows> bodies,
                     std::span<const LinkedRows> extra, PlaneDirection direction)
    : lattice_(&lattice), first_body_(at(bodies.front().begin).body),
      member_of_(std::size_t(at(bodies.back().begin).body - first_body_) + 1, -1),
      is_linked_(!extra.empty()) {
  for (const SweepRows& rows : bodies) {
    member_of_[std::size_t(at(rows.begin).body - first_body_)] = int(members_.size());
    members_.push_back({BodyPlanes(lattice, rows, direction), 0});
  }
  std::vector<std::vector<LinkedRows>> links_of(members_.size());
  for (const auto& [i, j] : extra) {
    links_of[std::size_t(member_of(at(i)))].push_back({i, j});
    links_of[std::size_t(member_of(at(j)))].push_back({j, i});
  }
  shift_bodies(links_of);
  for (const auto& [i, j] : extra) lag_ = std::max(lag_, 1 + std::abs(plane_of(i) - plane_of(j)));
  int least = 0;
  for (const Member& member : members_) least = std::min(least, member.shift);
  for (Member& member : members_) {
    member.shift -= least;
    planes_ = std::max(planes_, member.shift + member.planes.along);
  }
}

/// Goes from body to linked body, and puts each in the middle of where its links to the bodies
/// before it want it.
void BodyGroup::shift_bodies(const std::vector<std::vector<LinkedRows>>& links_of) {
  std::vector<bool> is_placed(members_.size());
  std::vector<int> placed{0};
  is_placed[0] = true;
  const auto place = [&](int m) {
    int least = std::numeric_limits<int>::max(), most = std::numeric_limits<int>::min();
    for (const auto& [own, other] : links_of[std::size_t(m)]) {
      if (!is_placed[std::size_t(member_of(at(other)))]) continue;
      const int shift = plane_of(other) - members_[std::size_t(m)].planes.plane_of(at(own));
      least = std::min(least, shift), most = std::max(most, shift);
    }
    members_[std::size_t(m)].shift = least + (most - least) / 2;
    is_placed[std::size_t(m)] = true;
    placed.push_back(m);
  };
  for (std::size_t n = 0; n < placed.size(); ++n)
    for (const LinkedRows& link : links_of[std::size_t(placed[n])])
      if (const int m = member_of(at(link.j)); !is_placed[std::size_t(m)]) place(m);
}

int BodyGroup::rows_behind() const {
  std::vector<int> across(std::size_t(planes_) + 1);
  for (const Member& member : members_) {
    across[std::size_t(member.shift)] += member.planes.across;
    across[std::size_t(member.shift + member.planes.along)] -= member.planes.across;
  }
  std::partial_sum(across.begin(), across.end(), across.begin());
  return lag_ * *std::max_element(across.begin(), across.end());
}

std::vector<BodyGroup> body_groups(const Lattice& lattice, SweepRows rows,
                                   std::span<const LinkedRows> extra, bool is_in_row_order) {
  const std::vector<SweepRows> bodies = bodies_of(lattice, rows);
  const auto index_of = [&](int row) {
    const auto after = std::upper_bound(bodies.begin(), bodies.end(), row,
                                        [](int r, const SweepRows& b) { return r < b.begin; });
    return int(after - bodies.begin()) - 1;
  };
  JoinedSets sets(bodies.size());
  std::vector<std::vector<LinkedRows>> links_of(bodies.size());
  for (const LinkedRows& link : extra)
    if (rows.has(link.i) && rows.has(link.j)) sets.join(index_of(link.i), index_of(link.j));
  for (const LinkedRows& link : extra)
    if (rows.has(link.i) && rows.has(link.j))
      links_of[std::size_t(sets.first_of(index_of(link.i)))].push_back(link);
  std::vector<std::vector<SweepRows>> members(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b)
    members[std::size_t(sets.first_of(int(b)))].push_back(bodies[b]);
  std::vector<BodyGroup> groups;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (members[b].empty()) continue;
    const auto group = [&](PlaneDirection direction) {
      return BodyGroup(lattice, members[b], links_of[b], direction);
    };
    groups.push_back(group(is_in_row_order ? PlaneDirection::row_order : PlaneDirection::longer));
    if (!groups.back().is_linked() || is_in_row_order) continue;
    for (const PlaneDirection direction : {PlaneDirection::y, PlaneDirection::z})
      if (BodyGroup other = group(direction); other.rows_behind() < groups.back().rows_behind())
        groups.back() = std::move(other);
  }
  return groups;
}

} // namespace dss
