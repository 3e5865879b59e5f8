#pragma once
/// Runs one cell of an atlas and measures what its case asks for.
///
/// error           state_error of the end against the reference
/// travel_error    how far displacements moved, against the reference: largest difference over the largest way
/// observed_order  log2 of the ratio of the errors with dt and dt / 2
/// energy_change   energy at the end over that at the start, less 1
/// energy_trend    mean energy over the last steps over that of the first ones, less 1: what is left when oscillations are averaged out
/// amplitude       largest displacement at the end over that at the start
/// tip_gap         distance of the centres of the first and the last element at the end, over that at rest
/// value           one field of one element at the end, over a scale
#include "experiments/runner/atlas/atlas_reference.hpp"
#include "variants/api.hpp"

#include <string>

namespace dss {

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

struct AtlasFigure {
  double value = 0;        ///< infinite where the run did not stay finite
  std::string breakdown{}; ///< then: at which step, time and element
};

/// Steps over which energy_trend averages, at either end of the run; a run has ten times as many at least.
constexpr long trend_window = 1200;

/// @param parameters  of the scene, for the metric's formulas
/// @throws InputError for what the variant, the scene or the reference cannot do
AtlasFigure measured_figure(const AtlasCell& cell, const Parameters& parameters, AtlasReferences& references);

} // namespace dss
