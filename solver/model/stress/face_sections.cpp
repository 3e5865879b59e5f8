#include "solver/model/stress/face_sections.hpp"

#include "solver/model/energy.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace dss {
namespace {

constexpr std::uint32_t no_link = std::numeric_limits<std::uint32_t>::max();

Eigen::Vector3d vector_of(const Vec3& v) { return {v[0], v[1], v[2]}; }

Eigen::Vector3d arm_of(const Body& body, std::size_t face) {
  const auto axis = Eigen::Index(face / 2);
  return (face % 2 == 1 ? 0.5 : -0.5) * body.edge[face / 2] * Eigen::Vector3d::Unit(axis);
}

/// Calls visit(item) for the items of a face, in a list that ascends by faces.
template <class List, class Visit>
void each_at(const List& list, std::size_t face, Visit&& visit) {
  const auto is_before = [](const auto& item, std::size_t wanted) { return item.face < wanted; };
  for (auto item = std::lower_bound(list.begin(), list.end(), face, is_before);
       item != list.end() && item->face == face; ++item)
    visit(*item);
}

} // namespace

FaceSections::FaceSections(const Problem& problem, Rotation equations)
    : problem_(problem), is_linearised_(equations == Rotation::linearised),
      terms_(energy_terms(problem, equations)), body_of_(problem.lattice.element_count),
      links_(body_of_.size()), clamps_(body_of_.size()) {
  problem.lattice.for_each_element(
      [&](std::size_t e, const Row& row, int) { body_of_[e] = row.body; });
  for (auto& of_element : links_) of_element.fill(no_link);
  const std::size_t in_grid = terms_.links().size() - problem.extra_links.size();
  for (std::size_t l = 0; l < in_grid; ++l) {
    const auto& link = terms_.links()[l];
    const auto upper = 2 * std::size_t(terms_.axis(link)) + 1;
    links_[link.i][upper] = links_[link.j][upper - 1] = std::uint32_t(l);
  }
  add_extra_links();
  for (const Clamp& clamp : problem.clamps) {
    Clamp& all = clamps_[clamp.element];
    all.dofs |= clamp.dofs;
    for (std::size_t f = 0; f < 6; ++f) all.at_faces[f] |= clamp.at_faces[f];
  }
}

void FaceSections::take(std::span<const double> state, std::span<const double> signals) {
  fields_ = placed(terms_, state);
  strains_ = terms_.strains(fields_, signals);
  found_.clear();
  add_loads(signals);
}

void FaceSections::find_all() {
  std::vector<Section> all(terms_.links().size());
  for (std::size_t l = 0; l < all.size(); ++l) all[l] = found(l);
  found_ = std::move(all);
}

void FaceSections::add_extra_links() {
  for (std::size_t l = terms_.links().size() - problem_.extra_links.size();
       l < terms_.links().size(); ++l) {
    const auto& link = terms_.links()[l];
    const auto lower = 2 * std::size_t(terms_.axis(link));
    extra_links_.push_back({6 * link.i + lower + 1, l});
    extra_links_.push_back({6 * link.j + lower, l});
  }
  std::ranges::stable_sort(extra_links_, {}, &FaceLink::face);
}

void FaceSections::add_loads(std::span<const double> signals) {
  loads_.clear();
  for (std::size_t l = 0; l < problem_.loads.size() && !signals.empty(); ++l) {
    const Load& load = problem_.loads[l];
    if (load.face < 0) continue;
    for (const std::size_t e : load.elements)
      loads_.push_back({6 * e + std::size_t(load.face), signals[3 + l] * vector_of(load.force),
                        signals[3 + l] * vector_of(load.torque)});
  }
  std::ranges::stable_sort(loads_, {}, &FaceLoad::face);
}

reference::Motion<double> FaceSections::motion(std::size_t element) const {
  return terms_.placed(element, &fields_[element * field_count]);
}

Eigen::Matrix3d FaceSections::axes_of(const reference::Motion<double>& motion) const {
  return is_linearised_ ? Eigen::Matrix3d::Identity() : motion.rotation();
}

double FaceSections::area(std::size_t element, int axis) const {
  const Vec3& edge = body(element).edge;
  const auto a = std::size_t(axis);
  return edge[(a + 1) % 3] * edge[(a + 2) % 3];
}

std::size_t FaceSections::beyond(std::size_t element, std::size_t face) const {
  const std::uint32_t link = links_[element][face];
  if (link == no_link) return none;
  return face % 2 == 1 ? terms_.links()[link].j : terms_.links()[link].i;
}

/// The moment of a reaction about the point that its link acts at is half the difference of those
/// on its elements: the arms' share of them is the same on both.
Section FaceSections::found(std::size_t l) const {
  const auto& link = terms_.links()[l];
  const auto i = motion(link.i), j = motion(link.j);
  auto reaction = terms_.link_reaction(i, j, link);
  if (terms_.has_pressure(link)) {
    const auto pressure = terms_.pressure_on(link, terms_.resistance(link.i, strains_[link.i]),
                                             terms_.resistance(link.j, strains_[link.j]));
    const auto more = terms_.pressure_reaction_of(i, j, link, pressure);
    reaction.force += more.force;
    reaction.moment_i += more.moment_i;
    reaction.moment_j += more.moment_j;
  }
  const auto upper = 2 * std::size_t(terms_.axis(link)) + 1;
  const Eigen::Vector3d arm_i = axes_of(i) * arm_of(body(link.i), upper),
                        arm_j = axes_of(j) * arm_of(body(link.j), upper);
  return {reaction.force,
          (reaction.moment_i - reaction.moment_j - (arm_i - arm_j).cross(reaction.force)) / 2,
          axes_of(i) * terms_.stretch(i, j, link)};
}

const AxisConstants& FaceSections::link(std::size_t element, int axis) const {
  const auto lower = 2 * std::size_t(axis);
  std::size_t kind = 0;
  if (const std::size_t below = beyond(element, lower); below != none)
    kind = problem_.link_kind(below, axis);
  else if (beyond(element, lower + 1) != none)
    kind = problem_.link_kind(element, axis);
  return body(element).link(axis, kind);
}

/// A face without a link inside the body strains as its half of one would under its force:
///   f_a/A = k_n L/A e_a + p,   f_b/A = k_b L/A e_b
/// p: the element's pressure. That is how free half links are eliminated (ElementPressure).
Eigen::Vector3d FaceSections::open_stretch(std::size_t element, std::size_t face,
                                           const Eigen::Vector3d& force) const {
  const auto axis = Eigen::Index(face / 2);
  const AxisConstants& constants = link(element, int(axis));
  const double length = body(element).edge[face / 2];
  const double pressure =
      strains_.empty() ? 0 : terms_.resistance(element, strains_[element]).volume;
  const Eigen::Matrix3d own_axes = axes(element);
  Eigen::Vector3d own = own_axes.transpose() * force;
  own[axis] -= pressure * area(element, int(axis));
  for (Eigen::Index b = 0; b < 3; ++b) {
    const double k = b == axis ? constants.k_normal : constants.k_shear[std::size_t(b)];
    own[b] = k > 0 ? own[b] / (k * length) : 0;
  }
  return own_axes * own;
}

Face FaceSections::face(std::size_t element, std::size_t face) const {
  Face found;
  if (const std::uint32_t own = links_[element][face]; own != no_link) {
    found.kind = FaceKind::linked;
    found.section = section(own); // loads and joints behind it act on the volume
    for (const int b : {0, 1, 2})
      if ((clamps_[element].dofs & clamps_[beyond(element, face)].dofs & (dof_ux << b)) != 0)
        found.unknown |= std::uint8_t(1 << b);
    return found;
  }
  each_at(loads_, 6 * element + face, [&](const FaceLoad& load) {
    const double sign = face % 2 == 1 ? 1 : -1; // on a lower face it is what is below that loads
    const Eigen::Vector3d arm = axes(element) * arm_of(body(element), face);
    found.kind = FaceKind::loaded;
    found.section.force += sign * load.force;
    found.section.moment += sign * (load.moment - arm.cross(load.force));
  });
  each_at(extra_links_, 6 * element + face, [&](const FaceLink& joint) {
    found.kind = FaceKind::loaded;
    const Section of_joint = section(joint.link);
    found.section.force += of_joint.force;
    found.section.moment += of_joint.moment;
  });
  found.section.stretch = open_stretch(element, face, found.section.force);
  return found;
}

/// Degrees of freedom that clamps hold at a face: those of clamps that select it; at a free one,
/// and between two held elements, also those of clamps that select no face.
std::uint8_t FaceSections::clamped_at(std::size_t element, const Face& at, std::size_t face) const {
  const Clamp& clamp = clamps_[element];
  if (at.kind == FaceKind::linked) return at.unknown != 0 ? clamp.dofs : 0;
  std::uint8_t at_some = 0;
  for (const std::uint8_t dofs : clamp.at_faces) at_some |= dofs;
  const bool is_free = at.kind == FaceKind::free;
  return std::uint8_t(clamp.at_faces[face] | (is_free ? clamp.dofs & ~at_some : 0));
}

/// @param found  the faces of the element as links and loads leave them
/// @param held   one of them, which is changed
void FaceSections::continue_over_clamp(std::size_t element, std::size_t face, const Faces& found,
                                       Face& held) const {
  const Face &own = found[face], &opposite = found[face ^ 1];
  const std::uint8_t dofs = clamped_at(element, own, face);
  if (dofs == 0 || opposite.kind != FaceKind::linked) return;
  const std::size_t next = beyond(element, face ^ 1);
  const Face far = this->face(next, face ^ 1);
  const bool is_mirror =
      own.kind != FaceKind::linked && (clamps_[element].at_faces[face] & (dof_ux << face / 2)) != 0;
  for (const int b : {0, 1, 2}) {
    const auto bit = std::uint8_t(1 << b);
    const bool is_held =
        own.kind == FaceKind::linked ? (own.unknown & bit) != 0 : (dofs & (dof_ux << b)) != 0;
    const auto continued = [&](auto part) {
      const double behind = (opposite.section.*part)[b];
      const bool goes_on = far.kind != FaceKind::free && (far.unknown & bit) == 0;
      return goes_on ? 2 * behind - (far.section.*part)[b] : behind;
    };
    if ((opposite.unknown & bit) != 0) continue; // nothing is known behind it either
    if (is_held) {
      held.section.force[b] = continued(&Section::force);
      held.section.stretch[b] = continued(&Section::stretch);
      held.unknown &= std::uint8_t(~bit);
    } else if (is_mirror) {
      held.section.force[b] = -opposite.section.force[b];
      held.section.stretch[b] = -opposite.section.stretch[b];
    }
    if ((dofs & (dof_rx << b)) != 0)
      held.section.moment[b] = continued(&Section::moment);
    else if (is_mirror)
      held.section.moment[b] = -opposite.section.moment[b];
  }
}

Faces FaceSections::of(std::size_t element) const {
  Faces found;
  for (std::size_t f = 0; f < found.size(); ++f) found[f] = face(element, f);
  if (clamps_[element].dofs == 0) return found;
  Faces faces = found;
  for (std::size_t f = 0; f < faces.size(); ++f) continue_over_clamp(element, f, found, faces[f]);
  return faces;
}

} // namespace dss
