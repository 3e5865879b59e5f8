#pragma once
/// Compiles the table of kernel_set.hpp for one model, type and kind of lanes.
#include "kernels/stage_row/pressure_row.hpp"
#include "kernels/stage_row/stage_row.hpp"
#include "variants/engine/kernel_set.hpp"

#include <array>
#include <stdexcept>
#include <utility>

namespace dss {

/// Computes an extra link, of either law: KernelSet::extra_link, KernelSet::member_links.
/// @tparam R  T, or packs of an ensemble
template <Model model, class T, class R, class Number>
void compute_link(const ExtraLinkConstants<Number>& link, const T* fields_i, const T* fields_j,
                  T* wrench_i, T* wrench_j) {
  using S = Physics<model, R>;
  constexpr int width = int(sizeof(R) / sizeof(T));
  const auto read = [](const T* from, typename S::element& e) {
    each_component(e, [&](R& c) {
      if constexpr (width == 1)
        c = *from;
      else
        c = simd::load(from);
      from += width;
    });
  };
  const auto write = [](T* to, auto sum) {
    each_component(sum, [&](R& c) {
      if constexpr (width == 1)
        *to = c;
      else
        simd::store(to, c);
      to += width;
    });
    return to;
  };
  typename S::element i, j;
  read(fields_i, i);
  read(fields_j, j);
  const auto along = [&](auto axis) {
    const auto& b = link.body;
    const auto& a = b.axis[axis];
    const R edge_i(link.edge_i), edge_j(link.edge_j), half(T(0.5));
    const auto w = S::wrench_of_pair(i, j, axis, link.is_material,
                                     {edge_i, edge_j, R(a.k_s), R(a.k_ns), R(a.k_ts), R(a.d_s),
                                      R(a.d_ns), R(a.d_ts), R(a.k_z), R(a.k_xz), R(a.k_yz),
                                      R(a.d_z), R(a.d_xz), R(a.d_yz)},
                                     {edge_i, edge_i * half, R(b.tau), R(b.kt2), R(b.dt)},
                                     {edge_j, edge_j * half, R(b.tau), R(b.kt2), R(b.dt)});
    typename S::vec back = w.force;
    each_component(back, [](R& c) { c = -c; });
    write(write(wrench_i, w.force), w.moment_i);
    write(write(wrench_j, back), w.moment_j);
  };
  if (link.axis == 0) along(std::integral_constant<int, 0>{});
  if constexpr (S::axes > 1)
    if (link.axis == 1) along(std::integral_constant<int, 1>{});
  if constexpr (S::axes > 2)
    if (link.axis == 2) along(std::integral_constant<int, 2>{});
}

template <Model model, class T, Terms terms, LaneKind kind>
struct RowKernels {
  using P = Physics<model, simd::Pack<T>>;
  static constexpr int half_velocities =
      terms.is_velocity_dependent() ? P::vec_size + P::spin_size : 0;
  /// Numbers of an element in rows of Runge-Kutta methods, and of leapfrogs.
  static constexpr int fields = P::fields + pressure_parts(model, terms).count(),
                       leapfrog_fields = fields + half_velocities;
  static constexpr bool has_packs = simd::lanes<T> != 1;

  // A function of its own for an action is faster, and costs compile time (README.md). Rows without
  // such functions have one for all actions, which branches for each pack and looks up the distance
  // between packs.
  static constexpr bool is_single = sizeof(T) == sizeof(float);
  static constexpr bool is_ensemble = kind == LaneKind::members;
  /// Rows with pressures are many, so only those of solids and plates have such functions.
  static constexpr bool has_pressed_functions =
      P::axes == 3 && P::is_common && kind == LaneKind::neighbours;
  /// Builds that compile fast keep them where tests need them: in one variant of packs.
  static constexpr bool has_few_functions = model == Model::spatial &&
                                            kind == LaneKind::neighbours && terms.is_damped &&
                                            !terms.is_oblong && simd::lanes<double> == 4;
  static constexpr bool has_own_functions =
      ((has_all_kernels && !has_plain_rows) || has_few_functions) && kind != LaneKind::filled &&
      (!terms.has_pressure || has_pressed_functions) &&
      (is_single || is_ensemble ? P::is_common && !terms.is_full() : P::is_common || has_packs);
  /// The rest of the actions: in line in common damped rows, else called for each pack.
  static constexpr int rest = P::is_common && terms.is_damped && !terms.is_oblong &&
                                      !terms.is_full() && !is_ensemble && (has_packs || !is_single)
                                  ? rest_in_line
                                  : rest_called;
  static constexpr int in_place = half_velocities > 0 ? predicted_step : leapfrog_step;
  template <int action, int of_row>
  DSS_FLATTEN static bool run_stage(const RowTask<T>& task) {
    const StageRow<P, T, terms, kind> row{task};
    RowUpdate<P, T, simd::lanes<T>, action> update(task, row.update_scales());
    row.template run<of_row>(update);
    return simd::is_zero(row.checked(update.check()));
  }
  /// Rows of a body without pressures have more numbers than these beside a body that has them.
  template <int action, int of_row>
  static bool run_own(const RowTask<T>& task) {
    if (task.stride != of_row * simd::lanes<T>) return run_stage<rest_called, any_fields>(task);
    return run_stage<action, of_row>(task);
  }
  static bool stage(const RowTask<T>& task) {
    if constexpr (has_own_functions) {
      switch (task.action) { // as has_function says
      case plain_stage:
        return run_own<plain_stage, fields>(task);
      case combined_stage:
        return run_own<combined_stage, fields>(task);
      case in_place:
        return run_own<in_place, leapfrog_fields>(task);
      case kept_stage:
        if constexpr (is_single && has_packs) return run_own<kept_stage, P::fields + fields>(task);
        break;
      case kept_step:
        if constexpr (is_single && has_packs) return run_own<kept_step, P::fields + fields>(task);
        break;
      default:
        break;
      }
      return run_stage<rest, any_fields>(task);
    }
    return run_stage<any_action, any_fields>(task);
  }
  template <class Row>
  DSS_FLATTEN static void prime_with(const RowTask<T>& task, int axis) {
    const Row row{task};
    if constexpr (kind == LaneKind::neighbours)
      if (axis == 0) row.prime_x();
    if constexpr (P::axes > 1)
      if (axis == 1) row.prime(1);
    if constexpr (P::axes > 2)
      if (axis == 2) row.prime(2);
  }
  DSS_FLATTEN static void pressure(const RowTask<T>& task) {
    PressureRow<P, T, terms, kind>(task).run();
  }

  static constexpr KernelSet<T> make_set() {
    KernelSet<T> made{};
    made.terms = terms;
    made.stage = stage;
    made.prime = prime_with<StageRow<P, T, terms, kind>>;
    if constexpr (terms.has_pressure) {
      made.pressure = pressure;
      made.prime_pressure = prime_with<PressureRow<P, T, terms, kind>>;
    }
    if constexpr (is_ensemble)
      made.member_links = compute_link<model, T, simd::Pack<T>, LaneNumbers<T>>;
    else
      made.extra_link = compute_link<model, T, T, T>;
    return made;
  }

  static constexpr KernelSet<T> set = make_set();
};

/// Null if these terms are not compiled for the model.
template <Model model, class T, Terms terms, LaneKind kind>
constexpr const KernelSet<T>* compiled_set() {
  if constexpr (is_built(model) && is_compiled(model, terms))
    return &RowKernels<model, T, terms, kind>::set;
  else
    return nullptr;
}

template <Model model, class T, LaneKind kind>
const KernelSet<T>& kernels_of(const Terms& terms) {
  static constexpr auto sets = []<std::size_t... index>(std::index_sequence<index...>) {
    return std::array{compiled_set<model, T, compiled_terms[index], kind>()...};
  }
  (std::make_index_sequence<compiled_terms.size()>{});
  for (const KernelSet<T>* set : sets)
    if (set != nullptr && set->terms == terms) return *set;
  throw std::logic_error("kernel_set.hpp: this combination of terms is not compiled");
}

} // namespace dss
