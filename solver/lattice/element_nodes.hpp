#pragma once
/// Nodes: the corners of elements.
#include "solver/lattice/lattice.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace dss {

/// Numbers of the nodes of all elements. Elements of one body that meet at a corner share its node.
class ElementNodes {
public:
  /// @param lattice  its elements follow one another along x (x_stride is 1)
  explicit ElementNodes(const Lattice& lattice);

  std::size_t count() const { return count_; }
  /// By corner: bit a is 1 on the upper side of axis a.
  const std::array<std::uint32_t, 8>& of(std::size_t element) const { return nodes_[element]; }

private:
  std::vector<std::array<std::uint32_t, 8>> nodes_;
  std::size_t count_ = 0;
};

} // namespace dss
