#pragma once
/// How this program was built. build_info.cmake generates the values at each build.
#include <map>
#include <string>

namespace dss {

/// Source version and compiler of this program.
struct BuildInfo {
  std::string git_commit;
  bool git_dirty = true; ///< tracked files differed from the commit
  std::string compiler, flags, build_type;
  /// Digests of source code: "core" is all that measures (kernels, solver, variants, the layers of
  /// experiments below studies), "studies/KIND" is one kind of study. plots/tables/age.py compares
  /// them with the tree.
  std::map<std::string, std::string> sources;
  /// Versions of the Debian packages that a measurement depends on.
  std::map<std::string, std::string> packages;
};

/// The values of this build.
const BuildInfo& build_info();

} // namespace dss
