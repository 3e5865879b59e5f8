#pragma once
/// Compiles the table of kernel_set.hpp for one model and type.
#include "kernels/stage_row/stage_row.hpp"
#include "variants/engine/kernel_set.hpp"

#include <array>
#include <stdexcept>
#include <utility>

namespace dss {

template <Model model, class T, Terms terms>
struct RowKernels {
  using P = Physics<model, simd::Pack<T>>;
  static constexpr int half_velocities =
      terms.is_velocity_dependent() ? P::vec_size + P::spin_size : 0;
  static constexpr int leapfrog_fields = P::fields + half_velocities;
  static constexpr bool has_packs = simd::lanes<T> != 1;

  // A function of its own for an action is faster, and costs compile time (README.md). Rows without
  // such functions have one for all actions, which branches for each pack and looks up the distance
  // between packs.
  static constexpr bool is_single = sizeof(T) == sizeof(float);
  static constexpr bool has_own_functions =
      is_single ? P::is_common && !terms.is_full() : P::is_common || has_packs;
  /// The rest of the actions: in line in common damped rows, else called for each pack.
  static constexpr int rest = P::is_common && terms.is_damped && !terms.is_oblong &&
                                      !terms.is_full() && (has_packs || !is_single)
                                  ? rest_in_line
                                  : rest_called;
  static constexpr int in_place = half_velocities > 0 ? predicted_step : leapfrog_step;
  template <int action, int fields>
  DSS_FLATTEN static bool run_stage(const RowTask<T>& task) {
    const StageRow<P, T, terms, fields> row{task};
    RowUpdate<P, T, simd::lanes<T>, action> update(task, row.turn_scale());
    row.run(update);
    return update.is_finite();
  }
  static bool stage(const RowTask<T>& task) {
    if constexpr (has_own_functions) {
      switch (task.action) {
      case plain_stage:
        return run_stage<plain_stage, P::fields>(task);
      case combined_stage:
        return run_stage<combined_stage, P::fields>(task);
      case in_place:
        return run_stage<in_place, leapfrog_fields>(task);
      case kept_stage:
        if constexpr (is_single && has_packs) return run_stage<kept_stage, 2 * P::fields>(task);
        break;
      case kept_step:
        if constexpr (is_single && has_packs) return run_stage<kept_step, 2 * P::fields>(task);
        break;
      default:
        break;
      }
      return run_stage<rest, any_fields>(task);
    }
    return run_stage<any_action, any_fields>(task);
  }
  DSS_FLATTEN static void prime(const RowTask<T>& task, int axis) {
    const StageRow<P, T, terms> row{task};
    if constexpr (P::axes > 1)
      if (axis == 1) row.prime(1);
    if constexpr (P::axes > 2)
      if (axis == 2) row.prime(2);
  }

  using S = Physics<model, T>;
  static void extra_link(const ExtraLinkConstants<T>& link, const T* fields_i, const T* fields_j,
                         T* wrench_i, T* wrench_j) {
    typename S::element i, j;
    each_component(i, [&](T& c) { c = *fields_i++; });
    each_component(j, [&](T& c) { c = *fields_j++; });
    const auto along = [&](auto axis) {
      const auto& b = link.body;
      const auto& a = b.axis[axis];
      const auto w = S::wrench_of_pair(i, j, axis, link.is_material,
                                       {link.edge_i, link.edge_j, a.k_s, a.k_ns, a.d_s, a.d_ns,
                                        a.k_z, a.k_xz, a.k_yz, a.d_z, a.d_xz, a.d_yz},
                                       {link.edge_i, link.edge_i / 2, b.tau, b.kt2, b.dt},
                                       {link.edge_j, link.edge_j / 2, b.tau, b.kt2, b.dt});
      const auto add = [&](T* wrench, T sign, typename S::vec force, typename S::spin moment) {
        each_component(force,
                       [&](T& c) { *wrench = simd::fma(sign * link.unit, c, *wrench), ++wrench; });
        each_component(moment, [&](T& c) { *wrench = simd::fma(link.unit, c, *wrench), ++wrench; });
      };
      add(wrench_i, T(1), w.force, w.moment_i);
      add(wrench_j, T(-1), w.force, w.moment_j);
    };
    if (link.axis == 0) along(std::integral_constant<int, 0>{});
    if constexpr (S::axes > 1)
      if (link.axis == 1) along(std::integral_constant<int, 1>{});
    if constexpr (S::axes > 2)
      if (link.axis == 2) along(std::integral_constant<int, 2>{});
  }

  static constexpr KernelSet<T> set{terms, stage, prime, extra_link};
};

/// Null if these terms are not compiled for the model.
template <Model model, class T, Terms terms>
constexpr const KernelSet<T>* compiled_set() {
  if constexpr (is_built(model) && is_compiled(model, terms))
    return &RowKernels<model, T, terms>::set;
  else
    return nullptr;
}

template <Model model, class T>
const KernelSet<T>& kernels_of(const Terms& terms) {
  static constexpr auto sets = []<std::size_t... index>(std::index_sequence<index...>) {
    return std::array{compiled_set<model, T, compiled_terms[index]>()...};
  }
  (std::make_index_sequence<compiled_terms.size()>{});
  for (const KernelSet<T>* set : sets)
    if (set != nullptr && set->terms == terms) return *set;
  throw std::logic_error("kernel_set.hpp: this combination of terms is not compiled");
}

} // namespace dss
