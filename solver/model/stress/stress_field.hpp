#pragma once
/// Stress and strain of a state: of elements, on their faces, and of nodes.
#include "solver/lattice/element_nodes.hpp"
#include "solver/model/stress/face_sections.hpp"
#include "solver/model/stress/tensor.hpp"

#include <span>
#include <utility>
#include <vector>

namespace dss {

/// In the middle of an element, in global axes.
struct ElementStress {
  SymmetricTensor stress{}; ///< [Pa]
  SymmetricTensor strain{}; ///< tensor components: a shear is half the engineering shear
};

/// Stress by the virial theorem: the mean over an element is the symmetric part of
///   sum over axes a of n_a (x) (F_above + F_below) / 2A
///                    + sum over axes o across a of n_o (x) (M_above - M_below) x n_o / V
/// with the sections of its faces (face_sections.hpp). Strains are those of its links; each axis
/// with links has a share of a shear strain.
class StressField {
public:
  /// Without a state. All arguments are those of FaceSections.
  StressField(const Problem& problem, Rotation equations) : sections_(problem, equations) {}
  /// The stress of all elements of a state.
  StressField(const Problem& problem, std::span<const double> state, Rotation equations,
              std::span<const double> signals);

  /// A new state, of which single elements are wanted.
  void take(std::span<const double> state, std::span<const double> signals);
  ElementStress of(std::size_t element) const;
  FaceSections& sections() { return sections_; }

  /// Of all elements; empty after take().
  const std::vector<ElementStress>& elements() const& { return elements_; }
  std::vector<ElementStress> elements() && { return std::move(elements_); }
  /// In the middle of a face. The stress of an element varies linearly towards its neighbours. On a
  /// face without neighbour the components of its traction are that of its load, or 0. In an
  /// element without neighbours along the face's axis it varies with the moments of its links; the
  /// shear by the twist of a chain is left out.
  SymmetricTensor at_face(std::size_t element, std::size_t face) const;
  /// At a place in an element, from -1 to 1 along its axes.
  SymmetricTensor at(std::size_t element, const Vec3& place) const;
  /// Means of what the elements at a node have there.
  std::vector<SymmetricTensor> at_nodes(const ElementNodes& nodes) const;

private:
  ElementStress found(std::size_t element, const Faces& faces) const;
  SymmetricTensor step_to(std::size_t element, const Faces& faces, std::size_t face) const;
  SymmetricTensor on_face(std::size_t element, const Faces& faces, std::size_t face) const;

  FaceSections sections_;
  std::vector<ElementStress> elements_;
};

} // namespace dss
