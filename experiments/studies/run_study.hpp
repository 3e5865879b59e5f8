#pragma once
/// Runs the studies of a file, for all kinds: --dry-run, --resume, progress, output files and exit
/// codes.
#include "experiments/studies/study.hpp"

#include <string>

namespace dss {

/// Options of `dssbench experiment`.
struct StudyOptions {
  std::string scale = "host";
  std::string directory = "results"; ///< directory of raw/, tables/ and oracle/
  bool resumes = false;
  bool is_dry = false; ///< only print the plan
  long rounds = 0;     ///< stop after so many rounds of repetitions; 0: measure all
};

/// Name, title and scale of a study, as its output shows them.
struct StudyHead {
  std::string name, title, scale;
};

/// Runs one study and writes its tables. @return the exit code
int run_study(Study& study, const StudyHead& head, const StudyOptions& options);

/// Runs all studies of a file, given its name or path.
/// @return the largest exit code
/// @throws InputError with the file, the JSON pointer, the mistake and a correct example
int run_study_file(const std::string& name_or_path, const StudyOptions& options);

} // namespace dss
