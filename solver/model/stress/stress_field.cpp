#include "solver/model/stress/stress_field.hpp"

#include <cmath>
#include <utility>

namespace dss {
namespace {

bool has_links(const Faces& faces, int axis) {
  const auto lower = 2 * std::size_t(axis);
  return faces[lower].kind == FaceKind::linked || faces[lower + 1].kind == FaceKind::linked;
}

/// The part of a moment on a face across a that tractions cause by varying linearly along o. A
/// twist varies along the thickness of a plate; in other elements it is no such traction.
Eigen::Vector3d moment_along(const Eigen::Vector3d& moment, const Eigen::Matrix3d& axes,
                             const Faces& faces, int a, int o) {
  const bool is_plate = !has_links(faces, o) && has_links(faces, 3 - o - a);
  if (is_plate) return moment;
  return moment - axes.col(a).dot(moment) * axes.col(a);
}

/// Tractions on the planes across the element's axes, as rows, along these axes: the mean over the
/// element of what is a symmetric stress in the whole.
struct Tractions {
  Eigen::Matrix3d by_forces;  ///< sections of both faces
  Eigen::Matrix3d by_moments; ///< what their linear parts add to the planes across o
};

/// Integral of r (x) traction over the faces, over the volume: the arm of each face, and the
/// moment of each of its linear parts, whose moment is M = n_o x (integral of z_o traction).
Tractions tractions_of(const FaceSections& sections, std::size_t e, const Faces& faces) {
  const Eigen::Matrix3d axes = sections.axes(e);
  const Vec3& edge = sections.body(e).edge;
  const double volume = edge[0] * edge[1] * edge[2];
  Tractions t{Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero()};
  for (const int a : {0, 1, 2}) {
    const auto lower = 2 * std::size_t(a);
    const Section &below = faces[lower].section, &above = faces[lower + 1].section;
    t.by_forces.row(a) = (below.force + above.force).transpose() * axes / (2 * sections.area(e, a));
    for (const int o : {(a + 1) % 3, (a + 2) % 3}) {
      const Eigen::Vector3d moment = moment_along(above.moment - below.moment, axes, faces, a, o);
      t.by_moments.row(o) += moment.cross(axes.col(o)).transpose() * axes / volume;
    }
  }
  return t;
}

/// Strains of links and open faces, as rows like Tractions. Elements turn freely by part of the
/// shear, so links along both axes have the shear together; an axis without links leaves it to the
/// other. Half of the sum with the transpose is the strain.
Eigen::Matrix3d own_stretch(const Eigen::Matrix3d& axes, const Faces& faces) {
  Eigen::Matrix3d rows = Eigen::Matrix3d::Zero();
  for (const int a : {0, 1, 2}) {
    const auto lower = 2 * std::size_t(a);
    const Eigen::RowVector3d stretch =
        (faces[lower].section.stretch + faces[lower + 1].section.stretch).transpose() * axes / 2;
    if (has_links(faces, a))
      rows.row(a) = stretch;
    else
      rows(a, a) = stretch[a];
  }
  return rows;
}

/// Whether a face across an axis says nothing of a component (Face::unknown).
bool is_unknown(const Faces& faces, int axis, int component) {
  const auto lower = 2 * std::size_t(axis);
  return ((faces[lower].unknown | faces[lower + 1].unknown) & 1 << component) != 0;
}

/// Change of the stress from the middle of an element to its faces across o, by the moments of its
/// links along the other axes: sum of n_a (x) g, where the traction t + z g at the height z has the
/// moment M = I n_o x g, and I = A h_o^2 / 12.
Eigen::Matrix3d bending_step(const FaceSections& sections, std::size_t e, const Faces& faces,
                             int o) {
  const Eigen::Matrix3d axes = sections.axes(e);
  Eigen::Matrix3d step = Eigen::Matrix3d::Zero();
  for (const int a : {(o + 1) % 3, (o + 2) % 3}) {
    const auto lower = 2 * std::size_t(a);
    const Eigen::Vector3d moment = moment_along(
        (faces[lower].section.moment + faces[lower + 1].section.moment) / 2, axes, faces, a, o);
    const double section_modulus = sections.area(e, a) * sections.body(e).edge[std::size_t(o)] / 6;
    step += axes.col(a) * (moment.cross(axes.col(o)) / section_modulus).transpose();
  }
  return step;
}

/// A stress with a given traction on the planes across an axis.
SymmetricTensor with_traction(const SymmetricTensor& stress, const Eigen::Matrix3d& axes, int axis,
                              const Eigen::Vector3d& traction) {
  Eigen::Matrix3d own = axes.transpose() * matrix_of(stress) * axes;
  own.col(axis) = axes.transpose() * traction;
  own.row(axis) = own.col(axis).transpose();
  return symmetric_part(axes * own * axes.transpose());
}

} // namespace

StressField::StressField(const Problem& problem, std::span<const double> state, Rotation equations,
                         std::span<const double> signals)
    : StressField(problem, equations) {
  take(state, signals);
  sections_.find_all();
  std::vector<ElementStress> all(sections_.element_count());
  for (std::size_t e = 0; e < all.size(); ++e) all[e] = found(e, sections_.of(e));
  elements_ = std::move(all);
}

void StressField::take(std::span<const double> state, std::span<const double> signals) {
  elements_.clear();
  sections_.take(state, signals);
}

ElementStress StressField::of(std::size_t element) const {
  return elements_.empty() ? found(element, sections_.of(element)) : elements_[element];
}

/// A clamp holds elements from turning, and their links from straining, so one of the two shears
/// of the planes a, b may be unknown: it is the other one.
ElementStress StressField::found(std::size_t element, const Faces& faces) const {
  const Eigen::Matrix3d axes = sections_.axes(element);
  const auto [by_forces, by_moments] = tractions_of(sections_, element, faces);
  Eigen::Matrix3d stress = by_forces + by_moments, stretch = own_stretch(axes, faces);
  for (const int a : {0, 1, 2})
    for (const int b : {(a + 1) % 3, (a + 2) % 3}) {
      const double k = sections_.link(element, a).k_shear[std::size_t(b)] *
                       sections_.body(element).edge[std::size_t(a)];
      const double softness = k > 0 ? sections_.area(element, a) / k : 0;
      if (is_unknown(faces, b, a) && !is_unknown(faces, a, b)) {
        stress(a, b) = stress(b, a) = by_forces(a, b);
        stretch(a, b) = stretch(b, a) = softness * by_forces(a, b);
      } else if (!is_unknown(faces, a, b) && has_links(faces, a) && has_links(faces, b)) {
        stretch(a, b) += softness * by_moments(a, b);
      }
    }
  return {symmetric_part(axes * stress * axes.transpose()),
          symmetric_part(axes * stretch * axes.transpose())};
}

/// Change of the stress from the middle of an element to a face.
SymmetricTensor StressField::step_to(std::size_t element, const Faces& faces,
                                     std::size_t face) const {
  const std::size_t below = sections_.alike_beyond(element, face & ~std::size_t(1)),
                    above = sections_.alike_beyond(element, face | 1);
  const double half = face % 2 == 1 ? 0.5 : -0.5; // edges
  if (below == FaceSections::none && above == FaceSections::none) {
    const SymmetricTensor bent =
        symmetric_part(bending_step(sections_, element, faces, int(face / 2)));
    SymmetricTensor step{};
    add_scaled(2 * half, bent, step);
    return step;
  }
  const std::size_t low = below == FaceSections::none ? element : below,
                    high = above == FaceSections::none ? element : above;
  const double edges = low == element || high == element ? 1 : 2;
  SymmetricTensor step{};
  add_scaled(half / edges, of(high).stress, step);
  add_scaled(-half / edges, of(low).stress, step);
  return step;
}

SymmetricTensor StressField::on_face(std::size_t element, const Faces& faces,
                                     std::size_t face) const {
  SymmetricTensor stress = of(element).stress;
  add_scaled(1, step_to(element, faces, face), stress);
  if (faces[face].kind == FaceKind::linked) return stress;
  const int axis = int(face / 2);
  return with_traction(stress, sections_.axes(element), axis,
                       faces[face].section.force / sections_.area(element, axis));
}

SymmetricTensor StressField::at_face(std::size_t element, std::size_t face) const {
  return on_face(element, sections_.of(element), face);
}

SymmetricTensor StressField::at(std::size_t element, const Vec3& place) const {
  const Faces faces = sections_.of(element);
  const SymmetricTensor middle = of(element).stress;
  SymmetricTensor stress = middle;
  for (std::size_t a = 0; a < 3; ++a) {
    const double share = std::abs(place[a]);
    add_scaled(share, on_face(element, faces, 2 * a + (place[a] > 0 ? 1 : 0)), stress);
    add_scaled(-share, middle, stress);
  }
  return stress;
}

std::vector<SymmetricTensor> StressField::at_nodes(const ElementNodes& nodes) const {
  std::vector<SymmetricTensor> stress(nodes.count());
  std::vector<double> shares(nodes.count());
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const Faces faces = sections_.of(e);
    std::array<SymmetricTensor, 6> steps;
    for (std::size_t f = 0; f < steps.size(); ++f) {
      steps[f] = on_face(e, faces, f);
      add_scaled(-1, elements_[e].stress, steps[f]);
    }
    for (std::size_t corner = 0; corner < 8; ++corner) {
      const std::size_t node = nodes.of(e)[corner];
      add_scaled(1, elements_[e].stress, stress[node]);
      for (std::size_t a = 0; a < 3; ++a)
        add_scaled(1, steps[2 * a + (corner >> a & 1)], stress[node]);
      ++shares[node];
    }
  }
  for (std::size_t node = 0; node < stress.size(); ++node)
    for (double& component : stress[node]) component /= shares[node];
  return stress;
}

} // namespace dss
