#pragma once
/// A digest of what a problem has from files, for records that must not be mixed with those of
/// other input.
#include "solver/model/problem.hpp"

#include <string>

namespace dss {

/// Digest of shapes, sizes and places of elements, their materials, which of them are clamped,
/// loaded and linked, and tables of signals, 16 hexadecimal digits. All may come from files, which
/// the text of a scene does not hold.
std::string file_digest(const Problem& problem);

} // namespace dss
