#pragma once
/// An ensemble: problems on the same topology that are computed side by side, so that any body
/// fills the lanes of packs.
#include "solver/model/problem.hpp"

#include <span>
#include <string>
#include <vector>

namespace dss {

/// Members whose cells alternate along x: cell x of member m is cell x W + m of the lattice, where
/// W is the number of members. So element e of member m is element e W + m.
struct Ensemble {
  std::vector<const Problem*> members; ///< they outlive the ensemble
  std::vector<double> dt;              ///< step of each [s]
  Lattice lattice;
  std::size_t size() const { return members.size(); }
};

/// @param members  at least one, of the same topology and with as many loads
/// @param dt       step of each [s]
Ensemble interleave(std::vector<const Problem*> members, std::vector<double> dt);

/// Returns an empty text if two problems have the same topology: the same elements, links and laws.
/// Otherwise a few words say how the other differs.
std::string why_other_topology(const Problem& one, const Problem& other);

} // namespace dss
