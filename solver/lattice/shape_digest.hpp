#pragma once
/// A digest of geometry, for records that must not be mixed with those of another body.
#include "solver/lattice/lattice.hpp"

#include <string>

namespace dss {

/// Digest of which cells each body has, 16 hexadecimal digits. Cells may come from voxel files,
/// which the text of a scene does not hold.
std::string shape_digest(const Lattice& lattice);

} // namespace dss
