#pragma once
/// Verifies that variants are equivalent: against the oracle in long double, over numbers of
/// threads, and with each other (DESIGN.md section 6).
#include "solver/scene/scene.hpp"
#include "variants/api/api.hpp"

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
  std::string reason; ///< reason of a failure or a skip
};

/// Numbers of threads that must give the same bits.
constexpr int verified_threads[] = {1, 2, 3, 4, 7};

/// Verifies a distributed variant on the ranks of this job. For every model, precision,
/// decomposition and halo strategy, with the methods rk4 or smoothed_verlet, its state must have
/// the same bits as one process of the variant `part`. All ranks must call this function together.
/// Returns one row for each combination.
std::vector<VerifyRow> verify_ranks(const Scene& scene, long steps, const Plugin& distributed,
                                    const Plugin& part, int ranks, const std::string& device = "");

/// Verifies variants on a scene with `steps` steps, in each precision and each model that has the
/// scene's degrees of freedom:
/// (1) one evaluation of all derivatives, at a random state with large rotations, against the
/// oracle in long double;
/// (2) the state after a run, for each method, against the oracle in long double;
/// (3) equal bits for each number of threads, and for all variants that have FMA.
/// An exception of a variant is a failure with its message.
/// @param device  of variants on devices, see choose_device; a device without double precision
/// skips f64. no_device: variants on devices are left out, and hybrids compute without devices.
std::vector<VerifyRow> verify_scene(const Scene& scene, long steps,
                                    const std::vector<const Plugin*>& plugins,
                                    const std::string& device = "");

} // namespace dss
