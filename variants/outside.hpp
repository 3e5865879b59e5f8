#pragma once
/// Variants built outside the source tree: modules in directories that the user names. Their paths travel in the
/// environment, so that processes that this one starts, and modules that load variants themselves, know them too.
#include <string>
#include <vector>

namespace dss {

/// Directories of outside variants, separated by colons.
constexpr const char* variant_path_variable = "DSSBENCH_VARIANT_PATH";

/// Adds directories to the environment's, and writes all there as absolute paths, each once. To be called before any
/// variant is asked for. @throws InputError for what is no directory
void add_variant_path(const std::vector<std::string>& directories);

/// What is known of a module before any of its code runs: what NAME.json beside NAME.so says.
struct OutsideVariant {
  std::string name; ///< of the module's file where the description gives none
  std::string isa;
  std::string needs;    ///< CPU features, comma-separated
  std::string path;     ///< of the module
  std::string unusable; ///< what is wrong with the description, or empty
};

/// Every file *.so of the directories of the environment that are there, by name of file within each; last those that
/// are described wrongly or not at all.
std::vector<OutsideVariant> outside_variants();

} // namespace dss
