#include "solver/model/sufficiency/needs.hpp"
#include "solver/model/sufficiency/sufficiency.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace dss {
namespace {

const char* why_a_dof_stays_zero(Model model) {
  if (model == Model::axial)
    return "nothing pushes or turns across x: links along x have forces along x and no moments";
  if (is_of_plane(model)) return "the scene is symmetric about the plane z = const";
  return "without forces in the plane the linear equations leave it at rest";
}

/// Elements move alike, so the model needs only translations.
bool is_in_translation(const Problem& problem, Model model) {
  return has_rotation_vectors(model) && why_not_in_translation(problem).empty();
}

template <class Has>
bool any_link(const Problem& problem, const Has& has) {
  const auto of_body = [&](const Body& body) {
    bool found = false;
    body.each_kind(
        [&](const AxisConstants& a, int axis) { found = found || has(body.law, a, axis); });
    return found;
  };
  return std::ranges::any_of(problem.bodies, of_body) ||
         std::ranges::any_of(problem.extra_links, [&](const ExtraLink& link) {
           return has(link.law, link.constants, link.axis);
         });
}

Need need(std::string name, bool is_needed, std::string why, std::string why_not) {
  return {std::move(name), is_needed, is_needed ? std::move(why) : std::move(why_not)};
}

Need damping(const Problem& problem, Model model) {
  const bool is_damped =
      any_link(problem, [](LinkLaw, const AxisConstants& a, int) { return a.is_damped(); });
  return need("damping of links", is_damped && !is_in_translation(problem, model),
              "links have d or dt",
              is_damped ? "no link is strained" : "all constants d and dt are zero");
}

Need bending_stiffness(const Problem& problem, Model model) {
  const bool has =
      any_link(problem, [](LinkLaw, const AxisConstants& a, int) { return a.k_rot != Vec3{}; });
  const bool is_turned = model != Model::axial && !is_in_translation(problem, model);
  return need("rotational stiffness of links", has && is_turned, "links resist relative rotation",
              has ? "no element turns" : "kt is zero: links resist by their arms alone");
}

Need orthotropy(const Problem& problem, Model model) {
  const bool has = any_link(problem, [](LinkLaw law, const AxisConstants& a, int axis) {
    const auto [base, third] = shear_axes(axis);
    return law == LinkLaw::material &&
           (a.k_normal != a.k_shear[base] || a.k_normal != a.k_shear[third] ||
            a.k_rot[0] != a.k_rot[1] || a.k_rot[1] != a.k_rot[2]);
  });
  const bool is_along = model == Model::axial;
  return need("orthotropy of links", has && !is_along,
              "links are stiffer along their normal than across, or in one bending direction",
              has ? "links have normal forces alone"
                  : "links are as stiff along their normal as across");
}

Need pressure(const Problem& problem, Model model) {
  const bool has = problem.has_pressure(), is_along = model == Model::axial;
  return need("pressure of elements", has && !is_along,
              "links along different axes share the change of an element's volume, because nu is "
              "not 0",
              has ? "chains are free to contract" : "no body has a nu");
}

Need tensor_inertia(const Problem& problem, Model model) {
  const bool has = std::ranges::any_of(problem.bodies, &Body::has_tensor_inertia);
  std::string why_not = "inertia is a scalar: w x J w vanishes";
  if (has)
    why_not = is_of_plane(model) ? "all spin is about z"
                                 : "no element turns, or rotations are small to first order";
  const bool is_finite = model == Model::spatial || model == Model::small;
  return need("gyroscopic moment w x J w", has && is_finite,
              "inertia is a tensor, and spin may be about any axis", why_not);
}

Need ties(const Problem& problem) {
  const Stabilization& ties = problem.stabilization;
  return need("stabilization", ties.is_present(),
              fmt::format("k {:g} N/m, d {:g} N s/m, k_rot {:g} N m/rad, d_rot {:g} N m s/rad",
                          ties.k, ties.d, ties.k_rot, ties.d_rot),
              "the scene ties nothing to the frame");
}

Need loads(const Problem& problem) {
  std::size_t acting = 0, varying = 0;
  for (const Load& load : problem.loads) {
    acting += !is_zero_always(load.signal);
    varying += load.signal.kind != Signal::Kind::constant;
  }
  return need(
      "loads", acting > 0, fmt::format("{} that act, {} of them vary in time", acting, varying),
      problem.loads.empty() ? "the scene has none" : "those of the scene are zero at all times");
}

Need frame(const Problem& problem) {
  std::vector<std::string> axes;
  for (std::size_t a = 0; a < 3; ++a)
    if (!is_zero_always(problem.frame_acceleration[a])) axes.emplace_back(1, "xyz"[a]);
  return need("gravity and base motion", !axes.empty(),
              fmt::format("accelerate along {}", fmt::join(axes, ", ")),
              "the frame does not accelerate");
}

} // namespace

std::vector<Need> degrees_of_freedom(const Problem& problem, Model model) {
  int held = problem.clamps.size() == problem.lattice.element_count ? int(dof_all) : 0;
  for (const Clamp& clamp : problem.clamps) held &= clamp.dofs;
  std::vector<Need> needs;
  for (int dof = 0; dof < 6; ++dof) {
    const bool is_rotation = dof >= 3, has = degrees_of(model) & (1 << dof),
               is_held = held & (1 << dof);
    const bool stays = is_rotation && is_in_translation(problem, model);
    std::string why_none =
        has ? "all elements move alike: nothing turns" : why_a_dof_stays_zero(model);
    if (is_held) why_none = "clamped on every element";
    needs.push_back(need(std::string(dof_names[std::size_t(dof)]), has && !is_held && !stays,
                         "nothing proves that it stays zero", why_none));
  }
  return needs;
}

std::vector<Need> terms(const Problem& problem, Model model) {
  std::vector<Need> needs{damping(problem, model),
                          bending_stiffness(problem, model),
                          orthotropy(problem, model),
                          pressure(problem, model),
                          tensor_inertia(problem, model),
                          ties(problem),
                          loads(problem),
                          frame(problem)};
  needs.push_back(need("initial motions", !problem.initial_motions.empty(),
                       fmt::format("{} in the scene", problem.initial_motions.size()),
                       "the scene starts at rest"));
  needs.push_back(need("links outside the grid", !problem.extra_links.empty(),
                       fmt::format("{} of them", problem.extra_links.size()),
                       "all links are those of neighbours"));
  return needs;
}

} // namespace dss
