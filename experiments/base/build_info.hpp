#pragma once
/// How this program was built. build_info.cmake generates the values at each build.
#include <string>

namespace dss {

/// Source version and compiler of this program.
struct BuildInfo {
  std::string git_commit;
  bool git_dirty = true; ///< tracked files differed from the commit
  std::string compiler, flags, build_type;
};

/// The values of this build.
const BuildInfo& build_info();

} // namespace dss
