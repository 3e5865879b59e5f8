#pragma once
/// Equivalence of variants: against the oracle in long double, over thread counts, and with one another (DESIGN.md
/// section 6).
#include "solver/scene/scene.hpp"
#include "variants/api.hpp"

#include <optional>
#include <string>
#include <vector>

namespace dss {

/// One line of the equivalence table.
struct VerifyRow {
  enum class Verdict { passed, failed, skipped };
  std::string scene, model, precision, variant;
  std::string check; ///< "evaluation", "run rk4", "threads rk4", "bits rk4", ...
  std::optional<double> error, tolerance;
  Verdict verdict = Verdict::passed;
  std::string reason; ///< of a failure or a skip
};

/// Thread counts over which states must be equal to the last bit.
constexpr int verified_threads[] = {1, 2, 3, 4, 7};

/// Verifies a distributed variant on the ranks of this job: for every decomposition method and halo strategy, each integrator, model
/// and precision, equal bits with the variant that computes its parts, alone on one process. Collective; one row for each.
std::vector<VerifyRow> verify_ranks(const Scene& scene, long steps, const Plugin& distributed, const Plugin& part,
                                    int ranks, const std::string& device = "");

/// Verifies variants on a scene, `steps` steps long:
/// (1) one evaluation of all derivatives at a random state with large rotations against the oracle in long double;
/// (2) the state after the run, for every integrator, against the oracle in long double;
/// (3) equal bits for each thread count, and over all variants that have FMA.
/// Both precisions, and each model that is exact for the scene. A variant's exception is a failure with its message.
/// @param device  of variants on devices, see choose_device; one without double precision skips f64; no_device: variants
/// on devices are left out, hybrids compute without
std::vector<VerifyRow> verify_scene(const Scene& scene, long steps, const std::vector<const Plugin*>& plugins,
                                    const std::string& device = "");

/// A state with gaps of a hundredth of an edge, rotations up to 2.5 rad (about z only in the planar model) and
/// velocities, none along clamped degrees of freedom; for f32 rounded to float. The same for a seed on every machine.
std::vector<double> random_state(const Problem& problem, Model model, Precision precision, unsigned seed);

} // namespace dss
