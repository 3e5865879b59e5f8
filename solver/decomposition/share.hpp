#pragma once
/// Cells of each part, and the place of a part's elements in the whole problem.
#include <cstddef>
#include <string>
#include <vector>

namespace dss {

/// The cells x_begin <= x < x_end of a row of the lattice. Holes among them belong to no part.
struct Segment {
  int row = 0, x_begin = 0, x_end = 0;
  bool operator==(const Segment&) const = default;
};

/// A segment and the part that owns its elements.
struct Share {
  Segment segment;
  int part = 0;
  bool operator==(const Share&) const = default;
};

/// Every element belongs to exactly one part. Shares are ascending by row, then x. Neighbouring
/// segments of one part are merged.
struct Decomposition {
  std::string method; ///< "strips", "blocks", "metis", or the text in a file
  int parts = 1;
  std::vector<Share> shares;
};

/// Elements that follow one another in the part and in the original problem: the addresses of a
/// part in the original model.
struct Run {
  std::size_t local = 0, global = 0, count = 0;
};

} // namespace dss
