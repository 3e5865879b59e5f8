#pragma once
/// Outside variants: modules built outside the source tree, in directories that the user names. The
/// environment keeps the directories. So child processes know them too, and so do modules that load
/// variants themselves.
#include <string>
#include <vector>

namespace dss {

/// Environment variable: directories of outside variants, separated by colons.
constexpr const char* variant_path_variable = "DSSBENCH_VARIANT_PATH";

/// Adds directories to the environment variable, as absolute paths, each once. Call it before
/// anything asks for a variant.
/// @throws InputError if one is not a directory, or has a colon in its path
void add_variant_path(const std::vector<std::string>& directories);

/// What NAME.json beside NAME.so says of a module. It is read before any code of the module runs.
struct OutsideVariant {
  std::string name; ///< from the description; if it gives none, from the module's file
  std::string isa;
  std::string needs;    ///< CPU features, comma-separated
  std::string path;     ///< of the module
  std::string unusable; ///< empty, or what is wrong with the description
};

/// All files *.so in the existing directories of the environment variable, sorted by file name
/// within each directory. Modules with a faulty or missing description come last.
std::vector<OutsideVariant> outside_variants();

} // namespace dss
