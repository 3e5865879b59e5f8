#pragma once
/// Models: which degrees of freedom are integrated, and how. A new model is one algebra, one row of
/// model_descriptors and one block of physics.hpp.
#include "kernels/fields.hpp"
#include "kernels/precision.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace dss {

/// The models, in the order of their work per step, the cheapest first.
/// axial: ux alone.
/// bending: uz and the rotations about x and y, linear.
/// membrane: ux, uy and the rotation about z, linear.
/// planar: ux, uy and the rotation about z, finite rotations.
/// linear: six degrees of freedom, small displacements and rotations, so a link has constant
/// matrices.
/// small: six, rotation vectors, A = I + [theta]x.
/// spatial: six, finite rotations (unit quaternions).
enum class Model { axial, bending, membrane, planar, linear, small, spatial };

/// Flops an element and stage, damped, in the interior of a plate (two links an element), for the
/// paper's law (without bending, equal edges) or for the material law. A fused multiply-add counts
/// two. `stage` is out = y + beta f; `last_stage` has three increments and the check for finite
/// numbers. A test counts the operations.
struct RowFlops {
  int stage, last_stage;
  constexpr int rk4_step() const { return 3 * stage + last_stage; }
};

/// What defines a model besides its algebra, kernels/algebra/NAME.h.
struct ModelDescriptor {
  Model model{};
  std::string_view name{};         ///< as in scenes and on the command line
  std::span<const Field> fields{}; ///< those of the 13 fields that packs hold, in this order
  /// Components of a link's force and moment, as indices into force x, y, z, moment x, y, z. They
  /// are also the bits of Dof.
  std::span<const int> wrench{};
  int axes = 0; ///< number of axes x, y, z along which elements have links
  /// qx, qy, qz hold half of the rotation vector. Other parts of the program see the quaternions of
  /// these vectors.
  bool has_vectors = false;
  /// The equations of motion are linear in the state. Loads may vary in time.
  bool is_linear = false;
  bool is_common = false; ///< many runs use it, so that specialised code is worth its compile time
  RowFlops flops{}, material_flops{};

  /// Number of wrench components that are forces.
  constexpr int vec_size() const {
    int size = 0;
    for (const int component : wrench) size += component < 3;
    return size;
  }
  /// Number of wrench components that are moments.
  constexpr int spin_size() const { return int(wrench.size()) - vec_size(); }
};

namespace model_parts {
inline constexpr Field axial[] = {ux, vx}, bending[] = {uz, vz, qx, qy, wx, wy},
                       membrane[] = {ux, uy, vx, vy, qz, wz},
                       planar[] = {ux, uy, vx, vy, qs, qz, wz},
                       vectors[] = {ux, uy, uz, vx, vy, vz, qx, qy, qz, wx, wy, wz},
                       quaternions[] = {ux, uy, uz, vx, vy, vz, qs, qx, qy, qz, wx, wy, wz};
inline constexpr int along_x[] = {0}, across_plane[] = {2, 3, 4}, in_plane[] = {0, 1, 5},
                     in_space[] = {0, 1, 2, 3, 4, 5};
} // namespace model_parts

// clang-format off
/// In the order of `Model`.
inline constexpr std::array model_descriptors{
    ModelDescriptor{.model = Model::axial, .name = "axial",
                    .fields = model_parts::axial, .wrench = model_parts::along_x, .axes = 1,
                    .is_linear = true, .flops = {11, 31},
                    .material_flops = {20, 40}},
    ModelDescriptor{.model = Model::bending, .name = "bending",
                    .fields = model_parts::bending, .wrench = model_parts::across_plane, .axes = 2,
                    .has_vectors = true, .is_linear = true, .flops = {59, 119},
                    .material_flops = {102, 162}},
    ModelDescriptor{.model = Model::membrane, .name = "membrane",
                    .fields = model_parts::membrane, .wrench = model_parts::in_plane, .axes = 2,
                    .has_vectors = true, .is_linear = true, .is_common = true, .flops = {60, 120},
                    .material_flops = {97, 157}},
    ModelDescriptor{.model = Model::planar, .name = "planar",
                    .fields = model_parts::planar, .wrench = model_parts::in_plane, .axes = 2,
                    .is_common = true, .flops = {79, 148},
                    .material_flops = {368, 437}},
    ModelDescriptor{.model = Model::linear, .name = "linear",
                    .fields = model_parts::vectors, .wrench = model_parts::in_space, .axes = 3,
                    .has_vectors = true, .is_linear = true,
                    .flops = {123, 243},
                    .material_flops = {193, 313}},
    ModelDescriptor{.model = Model::small, .name = "small",
                    .fields = model_parts::vectors, .wrench = model_parts::in_space, .axes = 3,
                    .has_vectors = true, .flops = {165, 285},
                    .material_flops = {666, 786}},
    ModelDescriptor{.model = Model::spatial, .name = "spatial",
                    .fields = model_parts::quaternions, .wrench = model_parts::in_space, .axes = 3,
                    .is_common = true, .flops = {218, 347},
                    .material_flops = {927, 1056}},
};
// clang-format on
constexpr const ModelDescriptor& descriptor(Model model) {
  return model_descriptors[std::size_t(model)];
}
/// All models, the cheapest first.
inline constexpr std::array models = [] {
  std::array<Model, model_descriptors.size()> all{};
  for (std::size_t m = 0; m < all.size(); ++m) all[m] = model_descriptors[m].model;
  return all;
}();
static_assert(std::ranges::all_of(models, [](Model m) { return descriptor(m).model == m; }));
static_assert(models.back() == Model::spatial, "a model lacks its descriptor");

/// Calls action.operator()<model>() for each model.
template <class Action>
constexpr void for_each_model(Action&& action) {
  [&]<std::size_t... m>(std::index_sequence<m...>) {
    (action.template operator()<models[m]>(), ...);
  }
  (std::make_index_sequence<models.size()>{});
}

constexpr std::string_view name(Model model) { return descriptor(model).name; }
constexpr bool has_rotation_vectors(Model model) { return descriptor(model).has_vectors; }
constexpr bool is_linear(Model model) { return descriptor(model).is_linear; }
/// Degrees of freedom of a model, as bits of Dof.
constexpr std::uint8_t degrees_of(Model model) {
  int degrees = 0;
  for (const int component : descriptor(model).wrench) degrees |= 1 << component;
  return std::uint8_t(degrees);
}
/// True if all motion lies in a plane z = const and all rotation is about z.
constexpr bool is_of_plane(Model model) { return degrees_of(model) == (dof_ux | dof_uy | dof_rz); }
/// The model with a given name; nothing if there is none.
constexpr std::optional<Model> find_model(std::string_view text) {
  for (const Model model : models)
    if (name(model) == text) return model;
  return std::nullopt;
}
/// Names of all models, the cheapest first.
inline std::vector<std::string> model_names() {
  std::vector<std::string> names;
  for (const Model model : models) names.emplace_back(name(model));
  return names;
}
/// Values that --model and a scene's run.model accept.
inline std::vector<std::string> model_names_and_auto() {
  std::vector<std::string> names = model_names();
  names.emplace_back("auto");
  return names;
}

} // namespace dss
