#pragma once
/// The options of `dssbench run`.
#include "experiments/run/plan/run_request.hpp"
#include "experiments/run/statics/analysis.hpp"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace dss {

/// What the options of a run say.
struct RunArguments {
  RunRequest request;
  AnalysisRequest analysis;
  std::vector<std::string> set; ///< KEY=VALUE
};

/// Adds the scene and all options. `arguments` must live as long as `command`.
void add_run_options(CLI::App& command, RunArguments& arguments);

} // namespace dss
