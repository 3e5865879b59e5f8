#include "experiments/run/timed/output.hpp"
#include "solver/model/stress.hpp"

#include <filesystem>
#include <fmt/format.h>

namespace dss {

void write_state(const std::string& path, const Problem& problem, const std::vector<double>& state,
                 Rotation equations) {
  write_state_csv(path, problem, state, element_stress(problem, state, equations));
}

void FrameSeries::add(const Problem& problem, const std::vector<double>& state, Rotation equations,
                      double time) {
  if (output_.empty()) return;
  std::filesystem::path path(output_);
  if (is_series_)
    path.replace_filename(fmt::format("{}_{:04}.vtu", path.stem().string(), frames_.size()));
  write_vtu(path.string(), problem, state, element_stress(problem, state, equations));
  frames_.push_back({path.filename().string(), time});
}

void FrameSeries::discard() {
  for (const Frame& frame : frames_)
    std::filesystem::remove(std::filesystem::path(output_).replace_filename(frame.file));
  frames_.clear();
}

std::string FrameSeries::finish() const {
  if (!is_series_ || output_.empty()) return output_;
  const std::string index = std::filesystem::path(output_).replace_extension(".pvd").string();
  write_pvd(index, frames_);
  return fmt::format("{}, which lists {} files {} to {}", index, frames_.size(),
                     frames_.front().file, frames_.back().file);
}

} // namespace dss
