#pragma once
/// The table of kernel cases. It feeds three users: the tests (C++ against packs against OpenCL),
/// the declared costs, and the microbenchmarks.
#include "kernels/model.hpp"
#include "kernels/physics.hpp"

#include <cstddef>
#include <span>

namespace dss {

/// One kernel on plain operands: `inputs` numbers in, `outputs` numbers out, for one element or one
/// link.
template <class Real>
struct KernelCase {
  const char* name; ///< the function case_<name> of kernels/case_functions.h
  Model model;
  int inputs, outputs;
  int flops; ///< declared cost: a fused multiply-add counts two, a sign change none; tests count it
  void (*evaluate)(const Real* in, Real* out);
};

/// All cases of all models. Operands are numbers of type `Real`.
template <class Real>
std::span<const KernelCase<Real>> kernel_cases() {
  using S = Physics<Model::spatial, Real>;
  using P = Physics<Model::planar, Real>;
  using V = Physics<Model::small, Real>;
  using L = Physics<Model::linear, Real>;
  using B = Physics<Model::bending, Real>;
  using M = Physics<Model::membrane, Real>;
  constexpr Model spatial = Model::spatial, small = Model::small, linear = Model::linear,
                  bending = Model::bending, membrane = Model::membrane, planar = Model::planar;
  static constexpr KernelCase<Real> cases[] = {
      {"paper_link_x", spatial, 26, 9, 118, S::case_paper_link_x},
      {"paper_link_y", spatial, 26, 9, 118, S::case_paper_link_y},
      {"paper_link_z", spatial, 26, 9, 118, S::case_paper_link_z},
      {"plate_link_x", spatial, 26, 9, 95, S::case_plate_link_x},
      {"plate_link_y", spatial, 26, 9, 95, S::case_plate_link_y},
      {"plate_link_z", spatial, 26, 9, 95, S::case_plate_link_z},
      {"undamped_link_x", spatial, 26, 9, 70, S::case_undamped_link_x},
      {"undamped_link_y", spatial, 26, 9, 70, S::case_undamped_link_y},
      {"undamped_link_z", spatial, 26, 9, 70, S::case_undamped_link_z},
      {"material_link_x", spatial, 26, 9, 402, S::case_material_link_x},
      {"material_link_y", spatial, 26, 9, 402, S::case_material_link_y},
      {"material_link_z", spatial, 26, 9, 402, S::case_material_link_z},
      {"sheared_link_x", spatial, 26, 9, 477, S::case_sheared_link_x},
      {"sheared_link_y", spatial, 26, 9, 477, S::case_sheared_link_y},
      {"sheared_link_z", spatial, 26, 9, 477, S::case_sheared_link_z},
      {"pressed_link_x", spatial, 26, 9, 537, S::case_pressed_link_x},
      {"pressed_link_y", spatial, 26, 9, 537, S::case_pressed_link_y},
      {"pressed_link_z", spatial, 26, 9, 480, S::case_pressed_link_z},
      {"strain_x", spatial, 26, 4, 208, S::case_strain_x},
      {"strain_y", spatial, 26, 4, 208, S::case_strain_y},
      {"strain_z", spatial, 26, 4, 208, S::case_strain_z},
      {"elastic_link_x", spatial, 26, 9, 296, S::case_elastic_link_x},
      {"elastic_link_y", spatial, 26, 9, 296, S::case_elastic_link_y},
      {"elastic_link_z", spatial, 26, 9, 296, S::case_elastic_link_z},
      {"rotation", spatial, 13, 4, 21, S::case_rotation},
      {"rotation_cayley", spatial, 13, 4, 47, S::case_rotation_cayley},
      {"euler", spatial, 13, 3, 102, S::case_euler},
      {"rk_update", spatial, 5, 2, 13, S::case_rk_update},
      {"leapfrog", spatial, 25, 19, 96, S::case_leapfrog},
      {"stabilization", spatial, 13, 6, 24, S::case_stabilization},
      {"stress", spatial, 12, 7, 37, S::case_stress},
      {"paper_link_x", planar, 14, 4, 45, P::case_paper_link_x},
      {"paper_link_y", planar, 14, 4, 45, P::case_paper_link_y},
      {"plate_link_x", planar, 14, 4, 40, P::case_plate_link_x},
      {"plate_link_y", planar, 14, 4, 40, P::case_plate_link_y},
      {"undamped_link_x", planar, 14, 4, 25, P::case_undamped_link_x},
      {"undamped_link_y", planar, 14, 4, 25, P::case_undamped_link_y},
      {"material_link_x", planar, 14, 4, 159, P::case_material_link_x},
      {"material_link_y", planar, 14, 4, 159, P::case_material_link_y},
      {"pressed_link_x", planar, 14, 4, 161, P::case_pressed_link_x},
      {"strain_x", planar, 14, 4, 66, P::case_strain_x},
      {"elastic_link_x", planar, 14, 4, 112, P::case_elastic_link_x},
      {"elastic_link_y", planar, 14, 4, 112, P::case_elastic_link_y},
      {"rotation", planar, 7, 2, 3, P::case_rotation},
      {"rotation_cayley", planar, 7, 2, 15, P::case_rotation_cayley},
      {"leapfrog", planar, 13, 10, 41, P::case_leapfrog},
      {"stabilization", planar, 7, 3, 12, P::case_stabilization},
      {"paper_link_x", small, 24, 9, 78, V::case_paper_link_x},
      {"material_link_y", small, 24, 9, 293, V::case_material_link_y},
      {"pressed_link_y", small, 24, 9, 388, V::case_pressed_link_y},
      {"strain_y", small, 24, 4, 88, V::case_strain_y},
      {"euler", small, 12, 3, 15, V::case_euler},
      {"leapfrog", small, 24, 18, 58, V::case_leapfrog},
      {"paper_link_x", linear, 24, 9, 60, L::case_paper_link_x},
      {"paper_link_z", linear, 24, 9, 60, L::case_paper_link_z},
      {"material_link_x", linear, 24, 9, 65, L::case_material_link_x},
      {"material_link_y", linear, 24, 9, 65, L::case_material_link_y},
      {"material_link_z", linear, 24, 9, 65, L::case_material_link_z},
      {"sheared_link_x", linear, 24, 9, 69, L::case_sheared_link_x},
      {"pressed_link_x", linear, 24, 9, 72, L::case_pressed_link_x},
      {"strain_z", linear, 24, 4, 20, L::case_strain_z},
      {"elastic_link_x", linear, 24, 9, 31, L::case_elastic_link_x},
      {"euler", linear, 12, 3, 3, L::case_euler},
      {"paper_link_x", bending, 12, 5, 31, B::case_paper_link_x},
      {"material_link_x", bending, 12, 5, 35, B::case_material_link_x},
      {"material_link_y", bending, 12, 5, 35, B::case_material_link_y},
      {"sheared_link_y", bending, 12, 5, 39, B::case_sheared_link_y},
      {"pressed_link_y", bending, 12, 5, 40, B::case_pressed_link_y},
      {"strain_y", bending, 12, 4, 10, B::case_strain_y},
      {"rotation_cayley", bending, 6, 2, 6, B::case_rotation_cayley},
      {"paper_link_x", membrane, 12, 4, 29, M::case_paper_link_x},
      {"paper_link_y", membrane, 12, 4, 29, M::case_paper_link_y},
      {"material_link_x", membrane, 12, 4, 32, M::case_material_link_x},
      {"material_link_y", membrane, 12, 4, 32, M::case_material_link_y},
      {"pressed_link_y", membrane, 12, 4, 34, M::case_pressed_link_y},
      {"strain_y", membrane, 12, 4, 11, M::case_strain_y},
      {"rotation_cayley", membrane, 6, 1, 3, M::case_rotation_cayley},
  };
  return cases;
}

} // namespace dss
