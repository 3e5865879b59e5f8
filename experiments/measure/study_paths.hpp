#pragma once
/// Paths of the files that a study writes.
#include <string>

namespace dss {

/// Files of one study, and the directory that keeps oracle states.
struct StudyPaths {
  std::string raw, context, table, oracle_directory;
};

/// Returns DIRECTORY/raw/NAME.csv, DIRECTORY/raw/NAME.json, DIRECTORY/tables/NAME.csv and
/// DIRECTORY/oracle.
StudyPaths study_paths(const std::string& directory, const std::string& name);

/// Makes the directories. @throws InputError if a directory or a file cannot be written
void make_directories(const StudyPaths& paths);

} // namespace dss
