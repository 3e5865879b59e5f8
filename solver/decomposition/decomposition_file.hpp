#pragma once
/// The decomposition file: the paper's DEC data (figure 5: parts, boundary zones, addresses in the original model) as JSON. Format:
/// README.md of this folder.
#include "solver/decomposition/part.hpp"

#include <string>

namespace dss {

/// Writes a decomposition of a problem, with each part's boundary and halo of `depth` layers. @throws InputError if it cannot be written
void write_decomposition(const std::string& path, const Problem& problem, const Decomposition& decomposition,
                         int depth);

/// Reads a decomposition for a problem. @throws InputError: file, JSON pointer, what is wrong; also if the file was made for a problem
/// with other elements, or does not pass require_fit
Decomposition read_decomposition(const std::string& path, const Problem& problem);

/// Whether a text names a file: it has a slash or the ending .json.
bool is_file(const std::string& method_or_file);

/// By a method's name, or from a file (a name with a slash or the ending .json), for so many ranks.
/// @throws InputError as decompose and read_decomposition; also if the file has other than so many parts
Decomposition decomposition_for(const Problem& problem, const std::string& method_or_file, int ranks,
                                const Weights& weights = {});

} // namespace dss
