/// Constants of bodies and extra links in the form that the kernels take.
#include "solver/model/link_constants.hpp"
#include "variants/engine/lane_numbers.hpp"
#include "variants/engine/packed_rows.hpp"
#include "variants/engine/packs.hpp"

#include <cstddef>

namespace dss {

/// Unit of force of a law: the paper's law is computed in units of k [N/m], the material law in SI.
static double force_unit(LinkLaw law, const AxisConstants& a) {
  return law == LinkLaw::paper ? a.k_normal : 1;
}

template <class T>
BodyConstants<T> body_constants(const Body& body, const Stabilization& tie) {
  BodyConstants<T> c{};
  const double unit = force_unit(body.law, body.axis[0]);
  c.inverse_unit = T(1 / unit);
  if (body.law == LinkLaw::paper) set_paper_constants(c, body.axis[0]);
  for (std::size_t a = 0; a < 3; ++a) {
    c.edge[a] = T(body.edge[a]);
    c.half_edge[a] = c.edge[a] / 2;
    c.inverse_edge[a] = T(1 / body.edge[a]);
    set_material_constants(c.axis[a], body.axis[a], int(a));
    c.inertia[a] = T(body.inertia[a] / unit);
    c.inverse_inertia[a] = T(unit / body.inertia[a]);
  }
  c.edge_ratio = T(body.edge[1] / body.edge[0]);
  c.mass = T(body.mass / unit);
  c.inverse_mass = T(unit / body.mass);
  c.tie_k = T(tie.k / unit), c.tie_d = T(tie.d / unit), c.tie_k2_rot = T(2 * tie.k_rot / unit),
  c.tie_d_rot = T(tie.d_rot / unit);
  return c;
}

template <class T>
ExtraLinkConstants<T> extra_link_constants(const Problem& problem, const ExtraLink& link) {
  const auto edge = [&](std::size_t element) {
    const Row& row = problem.lattice.rows[row_of(problem.lattice, element)];
    return T(problem.bodies[std::size_t(row.body)].edge[std::size_t(link.axis)]);
  };
  ExtraLinkConstants<T> c{};
  c.is_material = link.law == LinkLaw::material;
  c.axis = link.axis;
  c.edge_i = edge(link.i), c.edge_j = edge(link.j);
  c.unit = T(force_unit(link.law, link.constants));
  if (!c.is_material) set_paper_constants(c.body, link.constants);
  set_material_constants(c.body.axis[link.axis], link.constants, link.axis);
  return c;
}

/// Sets a lane of all constants of a body: its numbers, and the ints behind them.
template <class T>
static void set_body_lane(BodyConstants<LaneNumbers<T>>& all, std::size_t lane,
                          const BodyConstants<T>& one) {
  constexpr std::size_t count = offsetof(BodyConstants<T>, is_accelerated) / sizeof(T);
  static_assert(offsetof(BodyConstants<LaneNumbers<T>>, is_accelerated) ==
                count * sizeof(LaneNumbers<T>));
  set_lane<T>(all, lane, one, count);
  all.is_accelerated |= one.is_accelerated;
  all.frame_signal = one.frame_signal; // members have equally many loads
}

template <class T, int W>
ExtraLinkConstants<LaneNumbers<T>>
PackedRows<T, W>::member_link_constants([[maybe_unused]] std::size_t link) const {
  ExtraLinkConstants<LaneNumbers<T>> all{};
  if constexpr (W == simd::lanes<T>)
    for (std::size_t m = 0; m < members_.size(); ++m) {
      const auto one = extra_link_constants<T>(*members_[m], members_[m]->extra_links[link]);
      all.is_material = one.is_material;
      all.axis = one.axis;
      all.edge_i.value[m] = one.edge_i;
      all.edge_j.value[m] = one.edge_j;
      set_body_lane(all.body, m, one.body);
    }
  return all;
}

template <class T, int W>
void PackedRows<T, W>::set_constants() {
  const auto constants = [](const Problem& problem, std::size_t b) {
    BodyConstants<T> body = body_constants<T>(problem.bodies[b], problem.stabilization);
    for (const Signal& a : problem.frame_acceleration) body.is_accelerated |= !is_zero_always(a);
    if (problem.has_rotating_frame())
      body.is_accelerated = true, body.frame_signal = int(3 + problem.loads.size());
    return body;
  };
  for (std::size_t b = 0; b < members_.front()->bodies.size(); ++b) {
    if (!is_ensemble()) {
      bodies_.push_back(constants(*members_.front(), b));
      continue;
    }
    member_bodies_.emplace_back();
    if constexpr (W == simd::lanes<T>)
      for (std::size_t m = 0; m < members_.size(); ++m)
        set_body_lane(member_bodies_.back(), m, constants(*members_[m], b));
  }
}

#define DSS_INSTANTIATE(T, W)                                                                      \
  template void PackedRows<T, W>::set_constants();                                                 \
  template ExtraLinkConstants<LaneNumbers<T>> PackedRows<T, W>::member_link_constants(std::size_t) \
      const;
DSS_EACH_PACK(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE
template ExtraLinkConstants<double> extra_link_constants(const Problem&, const ExtraLink&);
template ExtraLinkConstants<float> extra_link_constants(const Problem&, const ExtraLink&);

} // namespace dss
