#pragma once
/// Runs one cell of the failure atlas and measures its figure. The metrics are:
/// - error: state_error of the final state against the reference
/// - travel_error: largest difference of displacements from the reference, relative to the largest
/// distance moved
/// - observed_order: log2 of the ratio of the errors with dt and dt / 2
/// - energy_change: relative change of energy from the start to the end
/// - energy_trend: relative change of the mean energy from the first steps to the last; averaging
/// removes oscillations
/// - amplitude: largest displacement at the end, relative to that at the start
/// - tip_gap: distance between the centres of the first and the last element at the end, relative
/// to that at rest
/// - value: one field of one element at the end, relative to a scale
#include "experiments/studies/failures/atlas_reference.hpp"
#include "variants/api/api.hpp"

#include <string>

namespace dss {

/// One combination of case, scene, method, precision, rotation and step.
struct AtlasCell {
  const FailureCase& atlas;
  const Scene& scene;
  const Plugin& plugin;
  const Method& method;
  Precision precision = Precision::f64;
  Rotation rotation = Rotation::quaternion;
  Model model = Model::spatial;
  double dt = 0;
  long steps = 0;
};

/// Result of a cell.
struct AtlasFigure {
  double value = 0;        ///< infinite if the run became non-finite
  std::string breakdown{}; ///< step, time and element of a breakdown; else empty
};

/// Number of steps that energy_trend averages at each end of the run. A run needs at least ten
/// times as many steps.
constexpr long trend_window = 1200;

/// Runs a cell and measures its metric.
/// @param parameters  of the scene, for the formulas of the metric
/// @throws InputError if the variant, the scene or the reference does not support the cell
AtlasFigure measured_figure(const AtlasCell& cell, const Parameters& parameters,
                            AtlasReferences& references);

} // namespace dss
