#pragma once
/// The compiled row kernels of one (model, precision, terms), behind function pointers: the engine around them is
/// compiled once a precision.
#include "kernels/physics.hpp"
#include "kernels/stage_row/row.hpp"
#include "solver/model/model.hpp"

#include <array>
#include <stdexcept>

namespace dss {

/// Combinations that are compiled, per law from lean to full; a problem takes the first that covers what it needs.
/// One more row costs about 5 s of compile time a module.
inline constexpr std::array compiled_terms{
    // material, damped, bending, gyroscopic, tied, oblong
    Terms{false, false, false, false, false, false}, Terms{false, true, false, false, false, false},
    Terms{false, true, false, false, false, true},   Terms{false, true, true, true, true, true},
    Terms{true, false, false, false, false, false},  Terms{true, true, false, false, false, false},
    Terms{true, true, true, true, true, false},
};

/// Models that few runs take leave out what few scenes have, and the full row covers. (Damped bodies of the material law had cost 6 to 9 % there.)
constexpr bool is_compiled(Model model, const Terms& terms) {
  if (model == Model::spatial || model == Model::planar) return true;
  const bool is_full = terms.is_gyroscopic && terms.is_tied;
  return is_full || terms.is_material || !terms.is_oblong;
}

/// What the terms of a row make of its memory.
struct RowShape {
  Terms terms;              ///< one of compiled_terms
  int carry_components = 0; ///< of a link's force (and couple) in a carry buffer
  int leapfrog_fields =
      0; ///< an element of a leapfrog row holds: half-step velocities too where forces depend on velocities
};
/// The shape that a body takes. @throws std::logic_error if no compiled combination covers what it needs
RowShape row_shape(Model model, const Terms& need);

/// Constants of one link outside the grid; T-valued, both laws.
template <class T>
struct ExtraLinkConstants {
  bool is_material;
  int axis;
  T edge_i, edge_j, unit; ///< unit: as in BodyConstants
  BodyConstants<T> body;  ///< link constants only, on `axis`
};

template <class T>
struct KernelSet {
  Terms terms;
  /// One stage of a row, whatever its action; false if the last of a step left a velocity that is not finite.
  bool (*stage)(const RowTask<T>& task);
  /// Only the links from a row (its `in`, `upper_*`, `carry_*`) across an axis (1 or 2): what a block of rows needs
  /// from the row before it.
  void (*prime)(const RowTask<T>& task, int axis);
  /// A link outside the grid: fields of both elements in, wrenches (force then moment) added to both.
  void (*extra_link)(const ExtraLinkConstants<T>& link, const T* i, const T* j, T* wrench_i, T* wrench_j);
};

/// The kernels for a model and the terms of a shape. One definition a (model, precision): variants/engine/kernels_*.cpp.
#ifdef DSS_FEWER_MODELS
#define DSS_EACH_MODEL(act) act(spatial) act(bending) act(membrane) act(planar) act(axial)
#else
#define DSS_EACH_MODEL(act) act(spatial) act(small) act(linear) act(bending) act(membrane) act(planar) act(axial)
#endif
#define DSS_DECLARE(model)                                                                                             \
  const KernelSet<double>& model##_f64_kernels(const Terms& terms);                                                    \
  const KernelSet<float>& model##_f32_kernels(const Terms& terms);
DSS_EACH_MODEL(DSS_DECLARE)
#undef DSS_DECLARE

template <class T>
const KernelSet<T>& find_kernels(Model model, const Terms& terms) {
  switch (model) { // no default: a model without kernels is a warning here
#define DSS_FIND(name)                                                                                                 \
  case Model::name:                                                                                                    \
    if constexpr (sizeof(T) == sizeof(double))                                                                         \
      return name##_f64_kernels(terms);                                                                                \
    else                                                                                                               \
      return name##_f32_kernels(terms);
    DSS_EACH_MODEL(DSS_FIND)
#undef DSS_FIND
#ifdef DSS_FEWER_MODELS
  default:
    break;
#endif
  }
  throw std::logic_error("kernel_set.hpp: this model is not compiled");
}
#undef DSS_EACH_MODEL

} // namespace dss
