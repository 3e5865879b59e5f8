#pragma once
/// What built this program; the values are generated at each build by build_info.cmake.
#include <string>

namespace dss {

struct BuildInfo {
  std::string git_commit;
  bool git_dirty = true; ///< tracked files differed from the commit
  std::string compiler, flags, build_type;
};

const BuildInfo& build_info();

} // namespace dss
