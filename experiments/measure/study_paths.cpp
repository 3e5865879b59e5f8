#include "experiments/measure/study_paths.hpp"
#include "solver/error.hpp"
#include "solver/io/atomic_file.hpp"

#include <filesystem>
#include <fmt/format.h>

namespace dss {

StudyPaths study_paths(const std::string& directory, const std::string& name) {
  return {fmt::format("{}/raw/{}.csv", directory, name),
          fmt::format("{}/raw/{}.json", directory, name),
          fmt::format("{}/tables/{}.csv", directory, name), directory + "/oracle"};
}

void make_directories(const StudyPaths& paths) {
  for (const std::string& path : {paths.raw, paths.table, paths.oracle_directory + "/x"}) {
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
      throw InputError(fmt::format("--out: cannot make {}: {}", folder.string(), error.message()));
    require_writable(path);
  }
}

} // namespace dss
