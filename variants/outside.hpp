#pragma once
/// Variants built outside the source tree: modules in directories that the user names. Their paths travel in the
/// environment, so that processes that this one starts, and modules that load variants themselves, know them too.
#include <string>
#include <vector>

namespace dss {

/// Directories of outside variants, separated by colons.
constexpr const char* variant_path_variable = "DSSBENCH_VARIANT_PATH";

/// Adds directories to the environment's, as absolute paths, each once. To be called once, before any variant is asked
/// for. @throws InputError for what is no directory
void add_variant_path(const std::vector<std::string>& directories);

/// What is known of a module before any of its code runs: what NAME.json beside NAME.so says.
struct OutsideVariant {
  std::string name, isa;
  std::string needs; ///< CPU features, comma-separated
  std::string path;  ///< of the module
};

/// Every *.so of the directories of the environment, by name of file within each.
/// @throws InputError for a directory that is not there, a module without such a file, a file that says less
std::vector<OutsideVariant> outside_variants();

} // namespace dss
