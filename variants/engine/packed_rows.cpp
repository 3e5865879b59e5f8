#include "variants/engine/packed_rows.hpp"

#include "solver/model/link_constants.hpp"
#include "solver/model/needed_terms.hpp"
#include "variants/engine/packs.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace dss {

RowShape row_shape(Model model, const Terms& need) {
  for (const Terms& terms : compiled_terms) {
    if (!is_compiled(model, terms) || !terms.covers(need)) continue;
    const ModelDescriptor& layout = descriptor(model);
    const int all = int(layout.wrench.size());
    return {terms, terms.has_couples() ? all : layout.vec_size(),
            int(layout.fields.size()) + (terms.is_velocity_dependent() ? all : 0)};
  }
  throw std::logic_error("kernel_set.hpp: no compiled combination covers the terms of the problem");
}

std::size_t row_of(const Lattice& lattice, std::size_t element) {
  const auto after =
      std::upper_bound(lattice.rows.begin(), lattice.rows.end(), element,
                       [](std::size_t e, const Row& row) { return e < row.first_element; });
  return std::size_t(after - lattice.rows.begin()) - 1;
}

template <class T, int W>
Place place_of(const PackedRows<T, W>& packed, std::size_t element) {
  const std::size_t r = row_of(packed.lattice, element);
  Place place{r, 0, 0};
  const Row& row = packed.lattice.rows[r];
  const std::size_t end = r + 1 < packed.rows.size() ? packed.lattice.rows[r + 1].first_element
                                                     : packed.lattice.element_count;
  if (end - row.first_element == std::size_t(row.x_end - row.x_begin)) { // no holes
    const int x = row.x_begin + int(element - row.first_element);
    return {r, x / W - packed.rows[r].first_pack, x % W};
  }
  each_cell(packed.lattice, row, [&](std::size_t e, int x) {
    if (e == element) place.pack = x / W - packed.rows[r].first_pack, place.lane = x % W;
  });
  return place;
}

template <class T, int W>
PackedRows<T, W>::PackedRows(const Problem& problem, Model model, const Part* part, Memory& where,
                             const Ensemble* ensemble)
    : memory(where), lattice(ensemble == nullptr ? problem.lattice : ensemble->lattice),
      layout(descriptor(model)), rows(lattice.rows.size()), own_end(int(rows.size())), part_(part),
      applied_index_(lattice.rows.size(), -1) {
  if (ensemble != nullptr) members_ = ensemble->members;
  if (members_.empty()) members_ = {&problem};
  if (is_ensemble() && members_.size() != std::size_t(W))
    throw std::logic_error("packed_rows.hpp: an ensemble has a member a lane");
  reach = lattice.row_reach();
  if (part_ != nullptr) find_layers();
  choose_shapes(problem, model);
  set_constants();
  std::size_t packs = 0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const Row& row = lattice.rows[r];
    PackedRow<T>& packed = rows[r];
    packed.first_pack = row.x_begin / W;
    packed.packs = (row.x_end + W - 1) / W - packed.first_pack;
    packed.pack_offset = packs;
    packed.shape = shapes_[std::size_t(row.body)];
    if (is_ensemble())
      packed.members = &member_bodies_[std::size_t(row.body)];
    else
      packed.body = &bodies_[std::size_t(row.body)];
    packs += std::size_t(packed.packs);
    packs_across = std::max(packs_across, packed.first_pack + packed.packs);
    max_packs = std::max(max_packs, packed.packs);
  }
  mark_links();
  apply_loads();
  apply_extra_links(problem);
  apply_clamps();
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (applied_index_[r] < 0) continue;
    AppliedRow& row = *applied_[std::size_t(applied_index_[r])];
    row.applied.patterns = row.patterns.data();
    row.applied.pattern_count = int(row.patterns.size());
    row.applied.first = 0;
    row.applied.packs = rows[r].packs;
    if (row.free_lanes.empty() &&
        !row.patterns.empty()) { // loads but no clamps: only the packs with a load
      row.applied.first = row.patterns.front().first;
      int end = 0;
      for (const auto& p : row.patterns) {
        row.applied.first = std::min(row.applied.first, p.first);
        end = std::max(end, p.first + p.packs);
      }
      row.applied.packs = end - row.applied.first;
    }
    row.applied.free_lanes = row.free_lanes.empty() ? nullptr : row.free_lanes.data();
    rows[r].applied = &row.applied;
  }
}

template <class T, int W>
void PackedRows<T, W>::choose_shapes(const Problem& problem, Model model) {
  std::vector<Terms> needs = needed_terms(problem, model);
  const auto choose = [&] {
    shapes_.clear();
    for (const Terms& need : needs) shapes_.push_back(row_shape(model, need));
    return std::ranges::any_of(
        shapes_, [](const RowShape& shape) { return shape.terms.is_velocity_dependent(); });
  };
  if (choose() && !needs.front().is_velocity_dependent()) {
    for (Terms& need : needs) need.is_damped = true;
    choose(); // all bodies get the same width of leapfrog rows
  }
  for (const RowShape& shape : shapes_) {
    carry_size = std::max(carry_size, shape.carry_components * W);
    leapfrog_fields = std::max(leapfrog_fields, shape.leapfrog_fields);
  }
}

/// Sets a lane of all constants. Both structs hold their numbers in the same order, then an int.
template <class T>
static void set_lane(BodyConstants<LaneNumbers<T>>& all, std::size_t lane,
                     const BodyConstants<T>& one) {
  constexpr std::size_t count = offsetof(BodyConstants<T>, is_accelerated) / sizeof(T);
  static_assert(offsetof(BodyConstants<LaneNumbers<T>>, is_accelerated) ==
                count * sizeof(LaneNumbers<T>));
  const auto* const from = reinterpret_cast<const std::byte*>(&one);
  auto* const to = reinterpret_cast<std::byte*>(&all);
  for (std::size_t n = 0; n < count; ++n)
    std::memcpy(to + n * sizeof(LaneNumbers<T>) + lane * sizeof(T), from + n * sizeof(T),
                sizeof(T));
  all.is_accelerated |= one.is_accelerated;
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
      set_lane(all.body, m, one.body);
    }
  return all;
}

template <class T, int W>
void PackedRows<T, W>::set_constants() {
  const auto constants = [](const Problem& problem, std::size_t b) {
    BodyConstants<T> body = body_constants<T>(problem.bodies[b], problem.stabilization);
    for (const Signal& a : problem.frame_acceleration) body.is_accelerated |= !is_zero_always(a);
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
        set_lane(member_bodies_.back(), m, constants(*members_[m], b));
  }
}

template <class T, int W>
void PackedRows<T, W>::find_layers() {
  row_layer_.assign(rows.size(), UINT8_MAX);
  has_halo_.assign(rows.size(), false);
  for (std::size_t r = 0; r < rows.size(); ++r)
    each_cell(lattice, lattice.rows[r], [&](std::size_t element, int) {
      row_layer_[r] = std::min(row_layer_[r], part_->layer[element]);
      if (part_->layer[element] > 0) has_halo_[r] = true;
    });
  while (row_layer_[std::size_t(own_begin)] > 0) ++own_begin;
  while (row_layer_[std::size_t(own_end - 1)] > 0) --own_end;
}

template <class T, int W>
bool PackedRows<T, W>::reads_halo(int row) const {
  if (has_halo_.empty()) return false;
  const Row& r = lattice.rows[std::size_t(row)];
  for (const int read : {row, r.lower_y, r.upper_y, r.lower_z, r.upper_z})
    if (read >= 0 && has_halo_[std::size_t(read)]) return true;
  return false;
}

template <class T, int W>
std::optional<std::size_t> PackedRows<T, W>::first_failed(int row, const T* packs, int fields,
                                                          int member) const {
  std::optional<std::size_t> failed;
  each_cell(lattice, lattice.rows[std::size_t(row)], [&](std::size_t element, int x) {
    if (failed || x % lattice.x_stride != member) return;
    if (part_ != nullptr && part_->layer[element] > 0) return;
    const T* lane =
        packs + std::ptrdiff_t(x / W - rows[std::size_t(row)].first_pack) * fields * W + x % W;
    for (int f = 0; f < fields; ++f)
      if (!std::isfinite(lane[f * W])) failed = element;
  });
  return failed;
}

template <class T, int W>
void PackedRows<T, W>::mark_links() {
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const Row& row = lattice.rows[r];
    const auto links_to = [&](int other, int x) {
      return other >= 0 && lattice.is_present(lattice.rows[std::size_t(other)], x);
    };
    std::vector<PackMasks> of_row(std::size_t(rows[r].packs));
    each_cell(lattice, row, [&](std::size_t, int x) {
      PackMasks& masks = of_row[std::size_t(x / W - rows[r].first_pack)];
      const auto bit = simd::LaneMask(1u << (x % W));
      if (lattice.is_present(row, x + lattice.x_stride)) masks.link_x |= bit;
      if (links_to(row.upper_y, x)) masks.link_y |= bit;
      if (links_to(row.upper_z, x)) masks.link_z |= bit;
      if (links_to(row.lower_y, x)) masks.below_y |= bit;
      if (links_to(row.lower_z, x)) masks.below_z |= bit;
    });
    rows[r].masks = masks_.insert(std::move(of_row)).first->data();
  }
}

template <class T, int W>
typename PackedRows<T, W>::AppliedRow& PackedRows<T, W>::applied_row(std::size_t row) {
  if (applied_index_[row] < 0) {
    applied_index_[row] = int(applied_.size());
    applied_.push_back(std::make_unique<AppliedRow>());
  }
  return *applied_[std::size_t(applied_index_[row])];
}

template <class T, int W>
void PackedRows<T, W>::apply_loads() {
  for (std::size_t n = 0; n < members_.front()->loads.size(); ++n) apply_load(n);
}

template <class T, int W>
void PackedRows<T, W>::apply_load(std::size_t n) {
  const std::size_t components = layout.wrench.size();
  struct Loaded {
    Place place;
    const Load* load;
  };
  std::vector<Loaded> all;
  for (std::size_t m = 0; m < members_.size(); ++m)
    for (const std::size_t element : members_[m]->loads[n].elements)
      all.push_back({place_of(*this, element_of(m, element)), &members_[m]->loads[n]});
  std::ranges::stable_sort(
      all, {}, [](const Loaded& one) { return std::pair(one.place.row, one.place.pack); });
  for (std::size_t from = 0, to = 0; from < all.size(); from = to) {
    const std::size_t r = all[from].place.row;
    while (to < all.size() && all[to].place.row == r) ++to;
    const int first = all[from].place.pack, packs = all[to - 1].place.pack - first + 1;
    AppliedRow& row = applied_row(r);
    Buffer<T> values(std::size_t(packs) * components * W, memory);
    for (const auto& [place, load] : std::span(all).subspan(from, to - from))
      for (std::size_t c = 0; c < components; ++c) {
        const std::size_t w = std::size_t(layout.wrench[c]);
        values.data()[(std::size_t(place.pack - first) * components + c) * W +
                      std::size_t(place.lane)] = T(w < 3 ? load->force[w] : load->torque[w - 3]);
      }
    row.patterns.push_back({values.data(), int(3 + n), first, packs});
    row.values.push_back(std::move(values));
  }
}

template <class T, int W>
void PackedRows<T, W>::apply_extra_links(const Problem& problem) {
  stage_halo = reach;
  if (problem.extra_links.empty()) return;
  extra_.resize(rows.size());
  const int constant_one = int(3 + problem.loads.size());
  for (const ExtraLink& link : problem.extra_links) {
    const std::size_t linked[] = {row_of(lattice, element_of(0, link.i)),
                                  row_of(lattice, element_of(0, link.j))};
    stage_halo = std::max(stage_halo, std::abs(int(linked[0]) - int(linked[1])));
    for (const std::size_t r : linked) {
      if (!extra_[r].empty()) continue;
      extra_[r] = Buffer<T>(std::size_t(rows[r].packs) * layout.wrench.size() * W, memory);
      applied_row(r).patterns.push_back({extra_[r].data(), constant_one, 0, rows[r].packs});
    }
  }
}

template <class T, int W>
void PackedRows<T, W>::apply_clamps() {
  const std::size_t components = layout.wrench.size();
  for (std::size_t m = 0; m < members_.size(); ++m)
    for (const Clamp& clamp : members_[m]->clamps) {
      const Place place = place_of(*this, element_of(m, clamp.element));
      AppliedRow& row = applied_row(place.row);
      if (row.free_lanes.empty())
        row.free_lanes.assign(std::size_t(rows[place.row].packs) * components, all_lanes);
      for (std::size_t c = 0; c < components; ++c)
        if ((clamp.dofs >> layout.wrench[c] & 1) != 0)
          row.free_lanes[std::size_t(place.pack) * components + c] &=
              simd::LaneMask(~(1u << place.lane));
    }
}

template <class T, int W>
std::size_t PackedRows<T, W>::bytes() const {
  std::size_t sum = rows.size() * sizeof(PackedRow<T>) + applied_index_.size() * sizeof(int);
  for (const auto& masks : masks_) sum += masks.size() * sizeof(PackMasks);
  sum += member_bodies_.size() * sizeof(member_bodies_[0]);
  for (const auto& row : applied_) {
    sum += sizeof(AppliedRow) + row->free_lanes.size() * sizeof(simd::LaneMask);
    for (const Buffer<T>& values : row->values) sum += values.bytes();
  }
  for (const Buffer<T>& wrench : extra_) sum += wrench.bytes();
  return sum;
}

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
    set_material_constants(c.axis[a], body.axis[a]);
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
  set_material_constants(c.body.axis[link.axis], link.constants);
  return c;
}

#define DSS_INSTANTIATE(T, W)                                                                      \
  template class PackedRows<T, W>;                                                                 \
  template Place place_of(const PackedRows<T, W>&, std::size_t);
DSS_EACH_PACK(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE
template ExtraLinkConstants<double> extra_link_constants(const Problem&, const ExtraLink&);
template ExtraLinkConstants<float> extra_link_constants(const Problem&, const ExtraLink&);

} // namespace dss
