#pragma once
/// The compiled row kernels of one (model, precision, terms), behind function pointers. So the
/// engine around them is compiled only once for each precision.
#include "kernels/model.hpp"
#include "kernels/physics.hpp"
#include "kernels/stage_row/element_pressure.hpp"
#include "kernels/stage_row/row.hpp"

#include <array>
#include <stdexcept>

namespace dss {

/// The combinations of terms that are compiled: for each law from lean to full. A problem takes the
/// first one that covers what it needs. Each row of this table costs compile time (README.md).
inline constexpr std::array compiled_terms{
    // material, damped, bending, gyroscopic, tied, oblong, two shears, pressure
    Terms{false, false, false, false, false, false},
    Terms{false, true, false, false, false, false},
    Terms{false, true, false, false, false, true},
    Terms{false, true, true, true, true, true},
    Terms{true, false, false, false, false, false},
    Terms{true, true, false, false, false, false},
    Terms{true, true, false, false, false, false, true},
    Terms{true, true, true, true, true, false},
    Terms{true, true, true, true, true, false, true},
    Terms{true, false, false, false, false, false, false, true},
    Terms{true, true, false, false, false, false, false, true},
    Terms{true, true, false, false, false, false, true, true},
    Terms{true, true, true, true, true, false, true, true},
};

/// False with DSS_FEWER_KERNELS: only the models planar and spatial, whose rows are damped, or
/// full.
#ifdef DSS_FEWER_KERNELS
inline constexpr bool has_all_kernels = false;
#else
inline constexpr bool has_all_kernels = true;
#endif

/// True with DSS_PLAIN_ROWS. Then, as with DSS_FEWER_KERNELS, few rows have functions of their own
/// for actions (instantiate.hpp).
#ifdef DSS_PLAIN_ROWS
inline constexpr bool has_plain_rows = true;
#else
inline constexpr bool has_plain_rows = false;
#endif

/// Builds with fewer kernels leave out undamped and oblong rows, which damped and full rows cover.
/// Rarely used models leave out the damped oblong row of the paper's law; the full row covers it.
/// They keep all rows of the material law, since the full row in their place would be slower
/// (README.md). Of these, two shears are always in the full row and never in the others; spatial
/// rows have both. Of rows with pressures, only spatial ones may be undamped.
constexpr bool is_compiled(Model model, const Terms& terms) {
  if (!has_all_kernels && (!terms.is_damped || (terms.is_oblong && !terms.is_full()))) return false;
  if (terms.has_pressure && pressure_parts(model, terms).count() == 0) return false;
  if (terms.has_pressure && !terms.is_damped) return model == Model::spatial;
  if (terms.is_material && terms.has_two_shears != terms.is_full()) return model == Model::spatial;
  if (model == Model::spatial || model == Model::planar) return true;
  return terms.is_full() || terms.is_material || !terms.is_oblong;
}

/// How much memory an element of a row needs, as its terms require.
struct RowShape {
  Terms terms;              ///< one of compiled_terms
  int carry_components = 0; ///< numbers of a link's force (and couple) in a carry buffer
  /// Numbers of an element in a leapfrog row. They include half-step velocities if forces depend on
  /// velocities.
  int leapfrog_fields = 0;
  int pressure_fields = 0; ///< numbers of its pressure
};
/// The shape of the rows of a body.
/// @throws std::logic_error if no compiled combination covers what the body needs
RowShape row_shape(Model model, const Terms& need);

/// Constants of an extra link, which is a link outside the grid, for both laws.
/// @tparam Number  T, or LaneNumbers of an ensemble
template <class Number>
struct ExtraLinkConstants {
  bool is_material;
  int axis;
  Number edge_i, edge_j, unit; ///< unit of force, as in BodyConstants; sums apply it
  BodyConstants<Number> body;  ///< constants of links only, on `axis`
};

/// The row kernels of one combination of terms.
template <class T>
struct KernelSet {
  Terms terms;
  /// Computes one stage of a row, with any action.
  /// @return false if the last stage of a step left a velocity that is not finite
  bool (*stage)(const RowTask<T>& task);
  /// Computes only the links from a row (its `in`, `upper_*`, `carry_*`) to the next row across an
  /// axis (1 or 2; of a piece of a cut row also 0). A block of rows needs them from the row before
  /// its first.
  void (*prime)(const RowTask<T>& task, int axis);
  /// Computes the pressures of a row's elements at its `in`, which is its `out` too. Null for terms
  /// without pressure.
  void (*pressure)(const RowTask<T>& task);
  /// Computes only the strains of the links that prime computes. Null for terms without pressure.
  void (*prime_pressure)(const RowTask<T>& task, int axis);
  /// Computes an extra link, or of an ensemble the same link of all members.
  /// @param i, j                fields of the two elements; of an ensemble: packs
  /// @param wrench_i, wrench_j  output: the link's force, then moment, in units of its body
  void (*extra_link)(const ExtraLinkConstants<T>& link, const T* i, const T* j, T* wrench_i,
                     T* wrench_j); ///< null for an ensemble
  void (*member_links)(const ExtraLinkConstants<LaneNumbers<T>>& link, const T* i, const T* j,
                       T* wrench_i, T* wrench_j); ///< null unless for an ensemble
};

/// True if the members of an ensemble lie in the lanes of packs: the module has packs.
inline constexpr bool has_ensembles = simd::lanes<double> > 1;

/// True if rows of a model may be filled. Other models are not worth the compile time.
constexpr bool has_filled_rows(Model model) {
  return descriptor(model).is_common && !descriptor(model).is_linear;
}

/// True if this build has the kernels of a model.
constexpr bool is_built(Model model) { return has_all_kernels || has_filled_rows(model); }

/// The kernels of a model for terms of compiled_terms. The build makes one file for each model,
/// type and kind (kernels_of_model.cpp.in), which instantiates the template of instantiate.hpp.
template <Model model, class T, LaneKind kind>
const KernelSet<T>& kernels_of(const Terms& terms);

/// Finds the kernels of a model and the terms of a shape.
/// @throws std::logic_error for `members` in a module without packs, whose ensembles have one
/// member
template <class T>
const KernelSet<T>& find_kernels(Model model, const Terms& terms,
                                 LaneKind kind = LaneKind::neighbours) {
  const KernelSet<T>* found = nullptr;
  for_each_model([&]<Model each>() {
    if constexpr (is_built(each))
      if (each == model) {
        if (kind == LaneKind::neighbours) found = &kernels_of<each, T, LaneKind::neighbours>(terms);
        if constexpr (has_filled_rows(each))
          if (kind == LaneKind::filled) found = &kernels_of<each, T, LaneKind::filled>(terms);
        if constexpr (has_ensembles)
          if (kind == LaneKind::members) found = &kernels_of<each, T, LaneKind::members>(terms);
      }
  });
  if (found == nullptr) throw std::logic_error("kernel_set.hpp: these kernels are not compiled");
  return *found;
}

} // namespace dss
