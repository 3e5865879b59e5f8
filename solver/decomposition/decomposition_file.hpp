#pragma once
/// The decomposition file: the paper's DEC data (figure 5: parts, boundary zones, addresses in the
/// original model) as JSON. README.md of this folder has the format.
#include "solver/decomposition/part.hpp"

#include <string>

namespace dss {

/// Writes a decomposition of a problem, with each part's boundary and halo of `depth` layers.
/// @throws InputError if the file cannot be written
void write_decomposition(const std::string& path, const Problem& problem,
                         const Decomposition& decomposition, int depth);

/// Reads a decomposition for a problem.
/// @throws InputError with file, JSON pointer and what is wrong; also if the file was made for a
///     problem with other elements, or does not pass require_fit
Decomposition read_decomposition(const std::string& path, const Problem& problem);

/// True if a text names a file: it has a slash or ends in .json.
bool is_file(const std::string& method_or_file);

/// Decomposition for `ranks` ranks, by the name of a method or from a file (see is_file).
/// @throws InputError as decompose and read_decomposition; also if the file has another number of
///     parts
Decomposition decomposition_for(const Problem& problem, const std::string& method_or_file,
                                int ranks, const Weights& weights = {});

} // namespace dss
