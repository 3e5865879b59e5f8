/// Properties of random scenes: every CPU variant computes what the oracle does, and what differs
/// in threads, tiles or the width of packs has the same bits. CTest takes a fixed seed; others by
///
///     RC_PARAMS="max_success=1000 seed=7" build/ci/tests/properties/random_scenes_test
#include "tests/properties/random_scene.hpp"

#include "experiments/run/state/state_access.hpp"
#include "solver/error.hpp"
#include "solver/numerics/stability.hpp"
#include "solver/scene/scene.hpp"
#include "tests/equivalence/comparison.hpp"
#include "variants/engine/kernel_set.hpp"

#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <unistd.h>
#include <vector>

namespace dss::test {
namespace {

/// RapidCheck reads its parameters before the first property.
[[maybe_unused]] const int parameters_are_set = ::setenv("RC_PARAMS", "seed=1 max_success=100", 0);

/// A problem of a random scene with a step that its method bears.
struct Sample {
  Problem problem;
  Method method;
  Model model;
};

Problem problem_of(const Json& scene) {
  const std::string path =
      testing::TempDir() + "random_scene_" + std::to_string(::getpid()) + ".json";
  std::ofstream(path) << scene;
  struct Removal {
    const std::string& path;
    ~Removal() { std::filesystem::remove(path); }
  } removal{path};
  return load_scene(path).problem;
}

/// @return nothing if no element is left of a body with holes, if no step is stable, or if this
/// build lacks the model
std::optional<Sample> read(const RandomScene& random) {
  Sample sample{{}, *find_method(random.method), *find_model(random.model)};
  if (!is_built(sample.model)) return {};
  try {
    sample.problem = problem_of(random.scene);
  } catch (const InputError& error) {
    if (std::string_view(error.what()).find("porous body has no element") == std::string_view::npos)
      throw;
    return {};
  }
  if (sample.problem.has_rotating_frame()) sample.model = Model::spatial; // only this has it
  const double longest = stable_step(sample.problem, sample.method).dt;
  if (!(longest > 0)) return {};
  // Short enough that methods keep |q| = 1 to rounding: kernels and oracle agree for such q alone.
  sample.problem.dt = random.share * std::min(longest, 1e-4);
  sample.method = fitted(sample.problem, sample.method, sample.problem.dt);
  return sample;
}

std::vector<std::string> cpu_variants(bool has_fma) {
  std::vector<std::string> names;
  for (const std::string& name : usable_variants())
    if (const Plugin& plugin = load_variant(name);
        plugin.is_threaded && !is_composed(plugin) && (plugin.has_fma || !has_fma))
      names.push_back(name);
  return names;
}

/// Runs a sample as it asks for.
State end_of(const Sample& sample, const RandomScene& random, const std::string& variant,
             Precision precision, int threads, int tile) {
  if (!sample.problem.extra_links.empty()) tile = 0; // linked bodies have none
  RC_LOG() << variant << ' ' << name(precision) << ", " << threads << " threads\n";
  return VariantRun{load_variant(variant),
                    sample.problem,
                    sample.method,
                    sample.model,
                    precision,
                    threads,
                    sample.problem.dt,
                    tile}
      .after(initial_state(sample.problem), random.steps);
}

TEST(RandomScenes, have_variants_to_run_on) {
  if (cpu_variants(true).size() < 2) GTEST_SKIP() << "fewer than two variants with FMA";
}

RC_GTEST_PROP(RandomScenes, agree_with_the_oracle, (const RandomScene& random)) {
  const auto sample = read(random);
  RC_PRE(sample.has_value());
  const State expected = oracle_after(sample->problem, sample->method,
                                      initial_state(sample->problem), random.steps, sample->model);
  for (const std::string& variant : cpu_variants(false)) {
    const State end = end_of(*sample, random, variant, Precision::f64, random.threads, random.tile);
    RC_ASSERT(state_error(sample->problem, expected, end) <= 1e-10);
  }
}

RC_GTEST_PROP(RandomScenes, have_the_same_bits_in_packs_of_any_width, (const RandomScene& random)) {
  const auto sample = read(random);
  RC_PRE(sample.has_value());
  const std::vector<std::string> variants = cpu_variants(true);
  for (const Precision precision : {Precision::f64, Precision::f32}) {
    std::optional<State> first;
    for (const std::string& variant : variants) {
      if (!first) first = end_of(*sample, random, variant, precision, 1, 0);
      const State end = end_of(*sample, random, variant, precision, random.threads, random.tile);
      RC_ASSERT(differing_bits(*first, end, precision) == 0U);
    }
  }
}

} // namespace
} // namespace dss::test
