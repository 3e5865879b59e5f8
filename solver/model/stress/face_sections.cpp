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

void add(const Section& other, Section& section) {
  section.force += other.force;
  section.moment += other.moment;
  section.stretch += other.stretch;
}

} // namespace

FaceSections::FaceSections(const Problem& problem, Rotation equations)
    : problem_(problem), is_linearised_(equations == Rotation::linearised),
      terms_(energy_terms(problem, equations)), body_of_(problem.lattice.element_count),
      links_(body_of_.size()), clamps_(body_of_.size(), Clamp{0, 0, 0}) {
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
    clamps_[clamp.element].dofs |= clamp.dofs;
    clamps_[clamp.element].faces |= clamp.faces;
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
  std::ranges::sort(extra_links_);
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
          terms_.stretch(i, j, link)};
}

/// An open face strains as its half of a link would under the face's force:
///   f_a/A = k_n L/A e_a + p,   f_b/A = k_b L/A e_b
/// p: the element's pressure. That is how free half links are eliminated (ElementPressure).
Vec3 FaceSections::open_stretch(std::size_t element, int axis, const Eigen::Vector3d& force) const {
  const auto a = std::size_t(axis);
  const AxisConstants& link = body(element).axis[a];
  const double length = body(element).edge[a];
  const double pressure =
      strains_.empty() ? 0 : terms_.resistance(element, strains_[element]).volume;
  Eigen::Vector3d own = axes(element).transpose() * force;
  own[axis] -= pressure * area(element, axis);
  Vec3 stretch{};
  for (std::size_t b = 0; b < 3; ++b)
    if (const double k = b == a ? link.k_normal : link.k_shear[b]; k > 0)
      stretch[b] = own[Eigen::Index(b)] / (k * length);
  return stretch;
}

Face FaceSections::face(std::size_t element, std::size_t face) const {
  Face found;
  const auto of_face = [&](const auto& list, auto face_of) {
    return std::ranges::equal_range(list, 6 * element + face, {}, face_of);
  };
  for (const FaceLoad& load : of_face(loads_, &FaceLoad::face)) {
    const double sign = face % 2 == 1 ? 1 : -1; // on a lower face it is what is below that loads
    const Eigen::Vector3d arm = axes(element) * arm_of(body(element), face);
    found.kind = FaceKind::loaded;
    found.section.force += sign * load.force;
    found.section.moment += sign * (load.moment - arm.cross(load.force));
  }
  const auto joints = of_face(extra_links_, &FaceLink::face);
  const std::uint32_t own = links_[element][face];
  if (own == no_link && joints.empty()) {
    found.section.stretch = vector_of(open_stretch(element, int(face / 2), found.section.force));
    return found;
  }
  found.kind = FaceKind::linked;
  if (own != no_link) found.section = section(own); // loads behind it act on the volume
  for (const FaceLink& joint : joints) add(section(joint.link), found.section);
  return found;
}

Section FaceSections::held_section(std::size_t element, std::size_t held,
                                   const Section& opposite) const {
  Section continued = opposite;
  if (const std::size_t next = beyond(element, held ^ 1); next != none)
    if (const Face far = face(next, held ^ 1); far.kind != FaceKind::free) {
      continued.force += opposite.force - far.section.force;
      continued.moment += opposite.moment - far.section.moment;
      continued.stretch += opposite.stretch - far.section.stretch;
    }
  for (const int b : {0, 1, 2}) {
    if ((clamps_[element].dofs & (dof_ux << b)) == 0) {
      continued.force[b] = -opposite.force[b];
      continued.stretch[b] = -opposite.stretch[b];
    }
    if ((clamps_[element].dofs & (dof_rx << b)) == 0) continued.moment[b] = -opposite.moment[b];
  }
  return continued;
}

Faces FaceSections::of(std::size_t element) const {
  Faces faces;
  for (std::size_t f = 0; f < faces.size(); ++f) faces[f] = face(element, f);
  const Faces open = faces;
  const Clamp& clamp = clamps_[element];
  for (std::size_t f = 0; f < faces.size(); ++f)
    if ((clamp.faces >> f & 1) != 0 && clamp.dofs != 0 && open[f].kind != FaceKind::linked &&
        open[f ^ 1].kind == FaceKind::linked)
      faces[f] = {FaceKind::held, held_section(element, f, open[f ^ 1].section)};
  return faces;
}

} // namespace dss
