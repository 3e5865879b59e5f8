#include "solver/io/program_files.hpp"

#include <cstdlib>

namespace dss {

namespace fs = std::filesystem;

fs::path installed_prefix() {
  if (const char* chosen = std::getenv("DSSBENCH_PREFIX"); chosen != nullptr && *chosen != '\0')
    return chosen;
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  const fs::path prefix = folder.parent_path();
  return folder.filename() == "bin" && fs::is_directory(prefix / "share/dssbench", error)
             ? prefix
             : fs::path();
}

fs::path program_file(const fs::path& path) {
  const fs::path prefix = installed_prefix();
  return (prefix.empty() ? fs::path(DSS_SOURCE_DIR) : prefix / "share/dssbench") / path;
}

} // namespace dss
