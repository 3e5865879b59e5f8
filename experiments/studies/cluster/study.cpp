#include "experiments/studies/study.hpp"
#include "experiments/studies/cluster/cluster_study.hpp"

#include <filesystem>
#include <fmt/format.h>

namespace dss {
namespace {

/// Runs the simulations of a file. Measured times of the same file are shown beside them.
class Simulations : public Study {
public:
  explicit Simulations(const StudyFile& file) : name_(file.name), blocks_(read_simulation(file)) {}

  std::string plan(const StudyPaths&) const override {
    return fmt::format("{}: {} blocks to simulate\n", name_, blocks_.size());
  }

  StudyResult run(const StudyRun& how) override {
    const bool has_measured = std::filesystem::exists(how.paths.table);
    const Table table =
        simulate_study(name_, blocks_, has_measured ? read_csv(how.paths.table) : Table{});
    return result_of(name_ + "_simulated", table, "\n" + simulation_text(table));
  }

private:
  const std::string name_;
  const std::vector<SimulationBlock> blocks_;
};

} // namespace

extern const StudyKind cluster_kind;
const StudyKind cluster_kind{"simulation", read_study<Simulations>};

} // namespace dss
