#include "experiments/run/plan/names.hpp"

#include "experiments/run/cluster/simulation.hpp"
#include "solver/decomposition/decomposition.hpp"
#include "solver/model/rotation.hpp"
#include "solver/numerics/method.hpp"
#include "solver/scene/scene.hpp"
#include "variants/loading/loader.hpp"

#include <array>

namespace dss {
namespace {

using Names = std::vector<std::string>;

Names names_of_variants() {
  Names names{"auto"};
  for (const VariantStatus& variant : variants()) names.push_back(variant.name);
  return names;
}

Names names_of_scenes() {
  Names names;
  for (const SceneListing& scene : list_scenes()) names.push_back(scene.name);
  return names;
}

Names names_of_rotations() {
  Names names;
  for (const Rotation rotation : rotations) names.emplace_back(name(rotation));
  return names;
}

Names names_of_halos() {
  Names names{"auto"};
  for (const HaloStrategy& strategy : halo_strategies()) names.emplace_back(strategy.name);
  return names;
}

Names names_of_decompositions() {
  return {decomposition_methods().begin(), decomposition_methods().end()};
}

struct Kind {
  std::string_view name;
  Names (*names)();
};

constexpr std::array kinds = {
    Kind{"VARIANT", names_of_variants},
    Kind{"SCENE", names_of_scenes},
    Kind{"MODEL", model_names_and_auto},
    Kind{"INTEGRATOR", method_names},
    Kind{"ROTATION", names_of_rotations},
    Kind{"HALO", names_of_halos},
    Kind{"DECOMPOSITION", names_of_decompositions},
    Kind{"PLATFORM", Platform::names},
    Kind{"PRECISION",
         [] {
           return Names{"f64", "f32", "f32c"};
         }},
    Kind{"DEVICE",
         [] {
           return Names{"cpu", "gpu", "accelerator"};
         }},
    Kind{"SHARES",
         [] {
           return Names{"equal", "measured"};
         }},
    Kind{"BOUND",
         [] {
           return Names{"promote", "stop"};
         }},
    Kind{"ANALYSIS",
         [] {
           return Names{"dynamic", "static", "modal"};
         }},
    Kind{"SOLVER",
         [] {
           return Names{"auto", "direct", "cg", "newton", "relaxation"};
         }},
    Kind{"PRECONDITIONER",
         [] {
           return Names{"incomplete_cholesky", "block_jacobi"};
         }},
    Kind{"MASSES",
         [] {
           return Names{"scaled", "scene"};
         }},
    Kind{"QUANTITY",
         [] {
           return Names{"displacement", "stress", "energy"};
         }},
    Kind{"SCALE",
         [] {
           return Names{"smoke", "quick", "host", "full"};
         }},
    Kind{"WHAT",
         [] {
           return Names{"variants", "scenes",  "experiments", "methods",
                        "kernels",  "devices", "columns"};
         }},
    Kind{"SHELL",
         [] {
           return Names{"bash", "zsh", "fish"};
         }},
};

} // namespace

std::vector<std::string> names_of(std::string_view kind) {
  for (const Kind& one : kinds)
    if (one.name == kind) return one.names();
  return {};
}

} // namespace dss
