#include "experiments/run/timed/output.hpp"
#include "experiments/base/interrupt.hpp"
#include "solver/error.hpp"
#include "solver/io/picture/picture.hpp"
#include "solver/io/state_csv.hpp"
#include "solver/io/vtk/node_motion.hpp"
#include "solver/model/stress/stress_field.hpp"
#include "solver/numerics/signal_rows.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <utility>

namespace dss {
namespace {

bool is_finite(const SymmetricTensor& tensor) {
  return std::ranges::all_of(tensor, [](double value) { return std::isfinite(value); });
}
bool is_finite(const ElementStress& element) {
  return is_finite(element.stress) && is_finite(element.strain) &&
         std::isfinite(von_mises(element.stress));
}

/// @throws UnstableError if a stress is beyond the range of numbers; InputError if that holds from
/// the start
void require_finite(const Problem& problem, const StressField& field, Rotation equations) {
  const std::vector<ElementStress>& stress = field.elements();
  const auto wrong = std::ranges::find_if_not(
      stress, [](const ElementStress& element) { return is_finite(element); });
  if (wrong == stress.end()) return;
  const std::string what =
      fmt::format("{}: the stress of element {} is beyond the range of numbers", problem.name,
                  wrong - stress.begin());
  const StressField start(problem, initial_state(problem), equations, signals_at(problem, 0));
  if (std::ranges::all_of(start.elements(),
                          [](const ElementStress& element) { return is_finite(element); }))
    throw UnstableError(what + "; take a smaller --dt");
  throw InputError(what + "; give lengths and constants in SI units");
}

StressOutput stress_output(const Problem& problem, const std::vector<double>& state,
                           Rotation equations, std::span<const double> signals) {
  StressField field(problem, state, equations, signals);
  require_finite(problem, field, equations);
  ElementNodes nodes(problem.lattice);
  std::vector<SymmetricTensor> at_nodes = field.at_nodes(nodes);
  return {std::move(field).elements(), std::move(nodes), std::move(at_nodes)};
}

/// A unit [Pa] of which a stress has some to some thousand, and its prefix.
std::pair<double, const char*> stress_unit(double stress) {
  if (stress >= 1e9) return {1e9, "G"};
  if (stress >= 1e6) return {1e6, "M"};
  if (stress >= 1e3) return {1e3, "k"};
  return {1, ""};
}

struct StressPicture {
  std::vector<PictureFace> faces;
  double magnification = 1;
  double most_stress = 0; ///< at a node [Pa]
};

/// Largest extent of the nodes, and their largest displacement [m].
std::pair<double, double> extent_and_motion(const NodeMotion& motion) {
  Vec3 low = motion.rest.front(), high = low;
  double most = 0;
  for (std::size_t n = 0; n < motion.rest.size(); ++n) {
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], motion.rest[n][a]);
      high[a] = std::max(high[a], motion.rest[n][a]);
    }
    const Vec3& u = motion.displacement[n];
    most = std::max(most, std::hypot(u[0], u[1], u[2]));
  }
  return {std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]}), most};
}

StressPicture stress_picture(const Problem& problem, const std::vector<double>& state,
                             const StressOutput& stress) {
  constexpr double shown = 0.05; // of the extent
  const NodeMotion motion = node_motion(problem, state, stress.nodes);
  const auto [extent, most] = extent_and_motion(motion);
  StressPicture picture;
  if (most > 0 && shown * extent > most) picture.magnification = shown * extent / most;
  for (const SymmetricTensor& at_node : stress.at_nodes)
    picture.most_stress = std::max(picture.most_stress, von_mises(at_node));
  for (const OuterFace& face : outer_faces(problem.lattice)) {
    PictureFace& drawn = picture.faces.emplace_back();
    for (std::size_t n = 0; n < 4; ++n) {
      const std::size_t node = stress.nodes.of(face.element)[face.corners[n]];
      for (std::size_t a = 0; a < 3; ++a)
        drawn.corners[n][Eigen::Index(a)] =
            float(motion.rest[node][a] - motion.rest.front()[a] +
                  picture.magnification * motion.displacement[node][a]);
      drawn.values[n] = float(von_mises(stress.at_nodes[node]));
    }
  }
  return picture;
}

void write_state(FileSet& outputs, const std::string& path, const Problem& problem,
                 const std::vector<double>& state, Rotation equations,
                 std::span<const double> signals) {
  const StressField field(problem, state, equations, signals);
  require_finite(problem, field, equations);
  AtomicFile& file = outputs.open(path);
  write_state_csv(file, problem, state, field.elements());
  file.finish();
}

void write_picture(FileSet& outputs, const std::string& path, const Problem& problem,
                   const std::vector<double>& state, Rotation equations,
                   std::span<const double> signals) {
  StressPicture picture =
      stress_picture(problem, state, stress_output(problem, state, equations, signals));
  const auto [unit, prefix] = stress_unit(picture.most_stress);
  for (PictureFace& face : picture.faces)
    for (float& value : face.values) value /= float(unit);
  const PictureWords words{
      picture.magnification == 1
          ? problem.name
          : fmt::format("{}, displacements x {:.3g}", problem.name, picture.magnification),
      ColourScale{fmt::format("von Mises stress [{}Pa]", prefix), 0, picture.most_stress / unit}};
  AtomicFile& file = outputs.open(path);
  file.write(picture_svg(picture.faces, words));
  file.finish();
}

} // namespace

std::vector<std::string> final_files(const RunRequest& request) {
  std::vector<std::string> files = {request.state_csv, request.picture};
  std::erase(files, "");
  return files;
}

void write_final_files(FileSet& outputs, const RunRequest& request, const Problem& problem,
                       const std::vector<double>& state, Rotation equations,
                       std::span<const double> signals) {
  if (!request.state_csv.empty())
    write_state(outputs, request.state_csv, problem, state, equations, signals);
  if (!request.picture.empty())
    write_picture(outputs, request.picture, problem, state, equations, signals);
}

void FrameSeries::add(const Problem& problem, const std::vector<double>& state, Rotation equations,
                      std::span<const double> signals, double time) {
  if (output_.empty()) return;
  const std::filesystem::path path = next_file();
  try {
    const StressOutput stress = stress_output(problem, state, equations, signals);
    if (is_one_file()) {
      if (!whole_) whole_ = std::make_shared<VtkHdfFile>(output_);
      whole_->add(problem, time, state, stress);
    } else if (is_series_) {
      AtomicFile file(path.string());
      write_vtu(file, problem, time, state, stress);
      file.commit();
    } else {
      AtomicFile& file = outputs_->open(path.string());
      write_vtu(file, problem, time, state, stress);
      file.finish();
    }
    frames_.push_back({path.filename().string(), time});
    if (is_series_ && !is_one_file()) keep_index();
  } catch (...) {
    if (!keeps_finished_) discard();
    throw;
  }
}

std::string FrameSeries::next_file() const {
  std::filesystem::path path(output_);
  if (is_series_)
    path.replace_filename(fmt::format("{}_{:04}.vtu", path.stem().string(), frames_.size()));
  return path.string();
}

void FrameSeries::go_on(const std::vector<double>& times) {
  for (const double time : times) {
    const std::filesystem::path path = next_file();
    if (!std::filesystem::is_regular_file(path))
      throw InputError(fmt::format("{}: the frame at t = {:g} s, before the checkpoint, is not "
                                   "there; give --output and --frames of the interrupted run, or "
                                   "leave them out",
                                   path.string(), time));
    frames_.push_back({path.filename().string(), time});
  }
}

void FrameSeries::keep_index() {
  constexpr double interval_s = 1; // an index of thousands of frames at each of them takes long
  if (frames_.size() > 1 && seconds_since(indexed_) < interval_s) return;
  write_pvd(index(), frames_);
  indexed_ = Clock::now();
  say_when_interrupted(fmt::format("{} lists the frames so far; give the command again", index()));
}

void FrameSeries::discard() {
  if (is_one_file()) {
    whole_.reset();
    outputs_->drop(output_);
    frames_.clear();
    return;
  }
  if (!is_series_) {
    outputs_->drop(output_);
    frames_.clear();
    return;
  }
  for (const Frame& frame : frames_)
    std::filesystem::remove(std::filesystem::path(output_).replace_filename(frame.file));
  if (!frames_.empty()) std::filesystem::remove(index());
  frames_.clear();
}

std::string FrameSeries::index() const {
  return std::filesystem::path(output_).replace_extension(".pvd").string();
}

std::string FrameSeries::finish() const {
  if (is_one_file()) {
    if (whole_) {
      AtomicFile& file = outputs_->open(output_);
      whole_->copy_to(file);
      file.finish();
    }
    return fmt::format("{}, which has {} states", output_, frames_.size());
  }
  if (!is_series_ || output_.empty()) return output_;
  write_pvd(index(), frames_);
  return fmt::format("{}, which lists {} files {} to {}", index(), frames_.size(),
                     frames_.front().file, frames_.back().file);
}

} // namespace dss
