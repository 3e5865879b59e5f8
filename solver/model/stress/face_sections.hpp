#pragma once
/// What acts across the faces of elements.
#include "solver/model/problem.hpp"
#include "solver/model/rotation.hpp"
#include "solver/reference/dynamics.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace dss {

/// Resultants of the stress on a face: what the side above it, along its axis, exerts on the side
/// below. Both elements at a face have the same.
struct Section {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< global axes [N]
  Eigen::Vector3d moment = Eigen::Vector3d::Zero(); ///< about the face's centre, global axes [N m]
  /// Strain along the face's normal and shear across it, as one vector along global axes.
  Eigen::Vector3d stretch = Eigen::Vector3d::Zero();
};

enum class FaceKind {
  free,   ///< nothing acts
  linked, ///< by links
  loaded  ///< by loads that select the face (Load::face), or by extra links
};

struct Face {
  FaceKind kind = FaceKind::free;
  Section section;
  /// Components (x, y, z) of which the section says nothing, as bits: clamps hold both elements, so
  /// they do not strain their link.
  std::uint8_t unknown = 0;
};
/// Faces -x, +x, -y, +y, -z, +z of an element.
using Faces = std::array<Face, 6>;

/// The faces of all elements in a state. Sections are found when they are asked for.
class FaceSections {
public:
  /// @param problem    lives longer
  /// @param equations  equations that the states come from; links of other equations would be
  ///     strained by their rotations even at rest
  FaceSections(const Problem& problem, Rotation equations);
  /// @param state    field_count numbers an element (kernels/fields.hpp)
  /// @param signals  a row at the time of the state (solver/numerics/signal_rows.hpp); empty:
  ///     without loads
  void take(std::span<const double> state, std::span<const double> signals);
  /// Finds the sections of all links of the state, to be asked for more than once: 72 bytes a link.
  void find_all();

  /// On a face without neighbour, or with one that is held too, each component that a clamp holds
  /// continues the sections behind it linearly. If a clamp selects this face and holds its normal,
  /// a component that it leaves free is the negative of that on the opposite face: there is none
  /// in the middle, where clamps act.
  Faces of(std::size_t element) const;
  /// The element across a face, or `none`. Extra links do not count.
  std::size_t beyond(std::size_t element, std::size_t face) const;
  static constexpr std::size_t none = std::size_t(-1);
  /// The same; `none` if it is of another material, across which stress may jump.
  std::size_t alike_beyond(std::size_t element, std::size_t face) const {
    const std::size_t other = beyond(element, face);
    return other != none && problem_.material(other) == problem_.material(element) ? other : none;
  }

  /// Axes of an element as columns.
  Eigen::Matrix3d axes(std::size_t element) const { return axes_of(motion(element)); }
  const Body& body(std::size_t element) const {
    return problem_.bodies[std::size_t(body_of_[element])];
  }
  /// Constants of the links of an element along an axis: those below it, or above it, or of the
  /// body's first kind.
  const AxisConstants& link(std::size_t element, int axis) const;
  /// Of a face across an axis [m^2].
  double area(std::size_t element, int axis) const;
  std::size_t element_count() const { return body_of_.size(); }
  /// The terms of the equations, and the state as `placed` gives it (energy.hpp).
  reference::Dynamics<double>& terms() { return terms_; }
  std::span<const double> fields() const { return fields_; }

private:
  struct FaceLink {
    std::size_t face; ///< 6 element + number of the face
    std::size_t link;
  };
  struct FaceLoad {
    std::size_t face;
    Eigen::Vector3d force, moment; ///< on the element [N], [N m]
  };

  void add_extra_links();
  void add_loads(std::span<const double> signals);
  reference::Motion<double> motion(std::size_t element) const;
  Eigen::Matrix3d axes_of(const reference::Motion<double>& motion) const;
  Section found(std::size_t link) const;
  Section section(std::size_t link) const { return found_.empty() ? found(link) : found_[link]; }
  /// A face as links and loads leave it.
  Face face(std::size_t element, std::size_t face) const;
  Eigen::Vector3d open_stretch(std::size_t element, std::size_t face,
                               const Eigen::Vector3d& force) const;
  std::uint8_t clamped_at(std::size_t element, const Face& at, std::size_t face) const;
  void continue_over_clamp(std::size_t element, std::size_t face, const Faces& found,
                           Face& held) const;

  const Problem& problem_;
  bool is_linearised_;
  reference::Dynamics<double> terms_;
  std::vector<double> fields_;
  std::vector<reference::ElementStrain<double>> strains_; ///< as Dynamics::strains
  std::vector<Section> found_;                            ///< of all links, or empty
  std::vector<int> body_of_;
  std::vector<std::array<std::uint32_t, 6>> links_; ///< of the grid, by faces
  std::vector<FaceLink> extra_links_;               ///< ascending by face
  std::vector<FaceLoad> loads_;                     ///< ascending by face
  std::vector<Clamp> clamps_;                       ///< of each element
};

} // namespace dss
