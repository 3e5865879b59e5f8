#pragma once
/// Shared by tests of the OpenCL variants. They are skipped without a device, and may use a device
/// as one of another kind.
#include "tests/equivalence/comparison.hpp"
#include "tests/fixtures/problems.hpp"

#include <cstdlib>
#include <gtest/gtest.h>

namespace dss::test {

/// While this object lives, executors use the device as one of another kind.
class DeviceAs {
public:
  /// @param tile  null, or the tile of a GPU (variants/opencl/stage_tile.hpp)
  explicit DeviceAs(const char* kind, const char* tile = nullptr) {
    ::setenv("DSSBENCH_OPENCL_AS", kind, 1);
    if (tile != nullptr) ::setenv("DSSBENCH_STAGE_TILE", tile, 1);
  }
  DeviceAs(const DeviceAs&) = delete;
  DeviceAs& operator=(const DeviceAs&) = delete;
  ~DeviceAs() {
    ::unsetenv("DSSBENCH_OPENCL_AS");
    ::unsetenv("DSSBENCH_STAGE_TILE");
  }
};

class OpenCl : public testing::Test {
protected:
  void SetUp() override {
    if (!has("opencl")) GTEST_SKIP() << "opencl is not here";
    if (!packs().has_fma) GTEST_SKIP() << packs().name << " has no FMA";
  }
  /// The fastest variant of the CPU gives the expected bits.
  static const Plugin& packs() { return load_variant("auto"); }
};

struct NamedProblem {
  std::string name;
  Problem problem;
  bool is_flat = false, is_bar = false;
};
inline std::vector<NamedProblem> problems_of_all_terms() {
  return {{"plate", fixture::make_plate(19), true},
          {"everything", fixture::make_everything()},
          {"sponge", fixture::make_sponge(21, 6, 5, LinkLaw::paper, 1)},
          {"flat_sponge", fixture::make_sponge(37, 9, 1, LinkLaw::material, 3), true},
          {"flat_everything", fixture::make_flat_everything(), true},
          {"pressed_plate", fixture::make_pressed_plate(19, 25), true},
          {"pressed_everything", fixture::pressed(fixture::make_everything())},
          {"block", fixture::make_block(5, 4, 3, LinkLaw::material, 0)},
          {"damped_joint", fixture::make_damped_joint()},
          {"bars", fixture::make_bars(4, 37, LinkLaw::material), false, true}};
}

/// Whether a problem is run in a model and scheme. Each pairing is a program that PoCL compiles for
/// seconds. Every scheme runs the problem with all terms, common ones run the plate, every other
/// problem runs once. Rare models run once each, one of them in both families of methods.
inline bool is_run(const NamedProblem& c, Model model, const Scheme& scheme) {
  const bool is_f64 = scheme.precision == Precision::f64, is_rk4 = scheme.method.name == "rk4";
  const bool is_leapfrog = is_f64 && scheme.method.is_staggered();
  if (c.is_bar) // undamped: leapfrogs hold no half-step velocities
    return model == Model::axial && ((is_f64 && is_rk4) || scheme.method.is_staggered());
  if (model == Model::spatial) {
    if (c.name == "everything") return true;
    if (c.name == "pressed_plate" && (is_leapfrog || is_rk4)) return true;
    return is_rk4 ? is_f64 || c.name == "plate" : is_leapfrog && c.name == "damped_joint";
  }
  if (model == Model::planar) return c.is_flat && (c.name == "plate" || (is_f64 && is_rk4));
  if (model == Model::membrane && c.name == "plate") return is_leapfrog;
  if (model == Model::small && is_leapfrog) return c.name == "everything";
  if (!is_f64 || !is_rk4 || model == Model::axial) return false;
  if (c.name == "pressed_plate") return model == Model::bending;
  return c.name == (degrees_of(model) != dof_all ? "flat_everything" : "everything");
}

/// Calls visit(problem, run of `plugin`, start of the run) for every problem, model, precision and
/// method.
template <class Visit>
void each_run(const Plugin& plugin, Visit&& visit) {
  for (const NamedProblem& c : problems_of_all_terms())
    for (const Model model : models)
      for (const auto& [method, precision] : brief_schemes()) {
        if (!is_run(c, model, {method, precision})) continue;
        const State start = fixture::random_state(c.problem, 4, 1e-4, 0.02, 0.01);
        SCOPED_TRACE(c.name + ' ' + std::string(name(model)) + ' ' + std::string(name(precision)) +
                     ' ' + std::string(method.name));
        visit(VariantRun{plugin, c.problem, method, model, precision},
              rounded(restricted(start, model), precision));
      }
}

} // namespace dss::test
