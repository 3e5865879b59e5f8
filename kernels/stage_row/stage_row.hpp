#pragma once
/// The fused hot loop: one stage of one row of packs, from the stage's input to its output
/// (README.md of this folder). The order of summation of an element is x, y, z with the upper link
/// before the lower; then ties; then wrenches. It depends on neither threads nor lanes.
#include "kernels/physics.hpp"
#include "kernels/rk_update/update.hpp"
#include "kernels/stage_row/element_pressure.hpp"
#include "kernels/stage_row/row_packs.hpp"

#include <array>
#include <atomic>
#include <type_traits>

DSS_INLINE_BEGIN
namespace dss {

/// Value of fixed_fields: the stride of the task counts.
inline constexpr int any_fields = 0;

/// @tparam P  a model's physics over packs of T
/// @tparam terms  terms that are compiled in
/// @tparam kind  members: a pack's neighbours along x are the packs beside it, lane by lane.
///   filled: those across y and z are found by maps
template <class P, class T, Terms terms, LaneKind kind = LaneKind::neighbours>
struct StageRow {
  using R = typename P::real;
  using element = typename P::element;
  using vec = typename P::vec;
  using spin = typename P::spin;
  using rotor = typename P::rotor;
  static constexpr int W = simd::lanes<T>;
  static constexpr int wrench_components = P::vec_size + P::spin_size;
  /// Scalars that a pack of link forces (and couples) takes in a carry buffer.
  static constexpr int carry_size = (terms.has_couples() ? wrench_components : P::vec_size) * W;

  using prepared = typename P::prepared;
  using carried = typename P::carried;
  using wrench = typename P::wrench;
  using axis_law = typename P::axis_law;
  using exchange = typename P::exchange;
  static constexpr typename P::term_flags flags{
      terms.is_material, terms.is_damped, terms.is_bending,     terms.is_gyroscopic,
      terms.is_tied,     terms.is_oblong, terms.has_two_shears, terms.has_pressure};
  using pressure = typename P::pressure;
  static constexpr PressureParts parts = pressure_parts(P::of_model, terms);
  using Stored = StoredPressure<R, P::of_model, terms>;
  static_assert(parts.count() == 0 || sizeof(Stored) == std::size_t(parts.count()) * sizeof(R));

  const RowTask<T>& task;
  static constexpr bool is_ensemble = kind == LaneKind::members;
  static constexpr bool is_filled = kind == LaneKind::filled;
  static const auto& constants_of(const RowTask<T>& task) {
    if constexpr (is_ensemble)
      return *task.members;
    else
      return *task.body;
  }
  /// Its numbers convert to packs.
  const std::conditional_t<is_ensemble, BodyConstants<LaneNumbers<T>>, BodyConstants<T>>& body =
      constants_of(task);
  const std::array<typename P::paper_law, 3> laws{paper_law(0), paper_law(1), paper_law(2)};
  /// A spatial pack has more live values than there are registers. Parked rows store what the next
  /// pack takes of its preparation in memory once and load it where it is used. They also load the
  /// pack's own numbers again for each axis and for the update. Otherwise the compiler spills more.
  /// README.md has the measurements.
  static constexpr bool is_parked =
      P::axes == 3 && P::fields == 13 && !terms.is_material && !terms.is_bending && W > 1;
  /// Plain packs have every link in the plane, or across all faces, and no applied wrench. They
  /// take a copy of the loop's body without branches. Spatial rows that are not parked are slower
  /// with it: straight code over 13 fields spills more (README.md).
  static constexpr bool has_plain_path = !is_filled && (P::axes < 3 || P::fields < 13 || is_parked);
  /// With few registers, the copy for solids makes the compiler spill more in all copies
  /// (README.md).
  static constexpr bool has_solid_path =
      P::axes == 3 && has_plain_path && (W == 1 || simd::registers >= 32);
  /// With few registers, a fence for the compiler stands before the other path. Otherwise the
  /// compiler moves what both paths load to a place before the branch, and the plain path spills
  /// more. Scalar rows do not all gain from it (README.md).
  static constexpr bool has_path_fence =
      has_plain_path && !is_parked && W > 1 && simd::registers < 32;
  /// Copies of the loop's body.
  enum path { general_path, plane_path, solid_path };
  static path path_of(const PackMasks& masks) {
    constexpr simd::LaneMask all = simd::all_lanes<T>;
    if constexpr (P::axes == 1) return masks.link_x == all ? plane_path : general_path;
    if (P::axes == 3 && (masks.link_z | masks.below_z) != 0) {
      const bool is_inside = (masks.link_y & masks.below_y & masks.link_z & masks.below_z) == all;
      return has_solid_path && is_inside ? solid_path : general_path;
    }
    return (masks.link_x & masks.link_y & masks.below_y) == all ? plane_path : general_path;
  }

  typename P::paper_law paper_law(int axis) const {
    if (!terms.is_oblong) axis = 0;
    return {R(body.edge[axis]), R(body.half_edge[axis]), R(body.tau), R(body.kt2), R(body.dt)};
  }
  /// Of a pack, RowTask::link_index; null if all packs have the first.
  const int* links_of(int pack) const {
    if constexpr (!terms.is_material) return nullptr;
    return task.link_index == nullptr ? nullptr : task.link_index + 3 * std::ptrdiff_t(pack);
  }
  typename P::material_law material(int axis, const int* links) const {
    if constexpr (!terms.is_material) return {};
    const LinkLanes<T>& a = task.links[links == nullptr ? axis : links[axis]];
    const R edge(body.edge[axis]);
    return {edge,      edge,     R(a.k_s),  R(a.k_ns), R(a.k_ts), R(a.d_s),  R(a.d_ns),
            R(a.d_ts), R(a.k_z), R(a.k_xz), R(a.k_yz), R(a.d_z),  R(a.d_xz), R(a.d_yz)};
  }

  axis_law law(int axis, const int* links) const {
    return {laws[0], laws[std::size_t(axis)], material(axis, links), R(body.edge_ratio)};
  }
  prepared prepare(const T* p) const { return P::prepare(load_at<element>(p), laws[0], flags); }

  static constexpr int parked_size = is_parked ? 4 * P::vec_size * W : 1;
  static void park(T* p, const prepared& a) {
    store_next(p, a.pull);
    store_next(p, a.lower_x);
    store_next(p, a.x.arm);
    store_next(p, a.x.swing);
  }
  static prepared parked(const T* p, const T* fields) {
    prepared a{};
    a.pull = load_next<vec>(p);
    a.lower_x = load_next<vec>(p);
    a.x.arm = load_next<vec>(p);
    a.x.swing = load_next<vec>(p);
    a.e = load_at<element>(fields);
    return a;
  }

  template <bool is_plain = false>
  static void mask_links(simd::LaneMask mask, exchange& x) {
    if (is_plain || mask == simd::all_lanes<T>) return;
    keep_lanes(mask, x.force);
    if constexpr (terms.has_couples()) keep_lanes(mask, x.couple_i);
    if constexpr (terms.is_material) keep_lanes(mask, x.couple_j);
  }
  static void store_carry(T* p, const carried& c) {
    store_next(p, c.force);
    if constexpr (terms.has_couples()) store_next(p, c.couple);
  }
  static carried load_carry(const T* p) {
    carried c{zero<vec>(), zero<spin>()};
    c.force = load_next<vec>(p);
    if constexpr (terms.has_couples()) c.couple = load_next<spin>(p);
    return c;
  }

  template <class Tuple = element, int numbers = P::fields>
  Tuple load_upper(const T* upper, int pack, std::ptrdiff_t stride, int axis) const {
    if constexpr (is_filled)
      return load_mapped<Tuple, numbers>(upper, stride, task.maps[pack].upper(axis), task.places);
    else
      return load_at<Tuple>(upper + std::ptrdiff_t(pack) * stride);
  }

  static pressure widened(const Stored& stored) {
    pressure p = zero<pressure>();
    if constexpr (parts.has_volume) p.s = stored.s;
    if constexpr (parts.has_bending_x) p.x = stored.x;
    if constexpr (parts.has_bending_y) p.y = stored.y;
    if constexpr (parts.has_bending_z) p.z = stored.z;
    return p;
  }
  /// Place of the pressures in a pack: behind all else.
  std::ptrdiff_t pressure_at() const { return task.stride - parts.count() * W; }
  /// Of a pack's elements.
  Stored load_pressure(const T* pack) const {
    if constexpr (terms.has_pressure)
      return load_at<Stored>(pack + pressure_at());
    else
      return {};
  }
  Stored load_upper_pressure(const T* upper, int pack, std::ptrdiff_t stride, int axis) const {
    if constexpr (terms.has_pressure)
      return load_upper<Stored, parts.count()>(upper + pressure_at(), pack, stride, axis);
    else
      return {};
  }
  /// What the pressures of i and j do to their link.
  typename P::link_pressure between(const Stored& i, const Stored& j, const int axis) const {
    if constexpr (terms.has_pressure)
      return P::pressure_on_link(widened(i), widened(j), axis, R(body.inverse_edge[axis]),
                                 parts.has_bending());
    else
      return P::no_pressure();
  }
  carried load_lower(const T* from, int pack, int axis, simd::LaneMask below) const {
    if constexpr (is_filled) {
      const LaneMap<T>& map = task.maps[pack].lower(axis);
      carried c{load_mapped<vec, P::vec_size>(from, carry_size, map, task.places), zero<spin>()};
      // A map gives lanes without a lower neighbour another one's link, so they are cleared. Where
      // lanes are the same, the lower row left 0 there.
      keep_lanes(below, c.force);
      if constexpr (terms.has_couples()) {
        c.couple =
            load_mapped<spin, P::spin_size>(from + P::vec_size * W, carry_size, map, task.places);
        keep_lanes(below, c.couple);
      }
      return c;
    } else {
      return load_carry(from + std::ptrdiff_t(pack) * carry_size);
    }
  }

  /// Links across y or z. `upper` is the upper row; `carry` and `from` are carry buffers. Each may
  /// be null if no mask needs it.
  template <bool is_plain>
  void add_across(const prepared& i, const Stored& own_pressure, const int axis,
                  simd::LaneMask above, simd::LaneMask below, const T* upper, T* carry,
                  const T* from, int pack, const int* links, std::ptrdiff_t stride,
                  wrench& sum) const {
    if (!is_plain && (above | below) == 0) return;
    const axis_law own_law = law(axis, links);
    const typename P::side own = P::side_across(i, axis, own_law, flags);
    exchange up{zero<vec>(), zero<spin>(), zero<spin>()};
    if (is_plain || above != 0) {
      const element j = load_upper(upper, pack, stride, axis);
      const auto by_pressure =
          between(own_pressure, load_upper_pressure(upper, pack, stride, axis), axis);
      up = P::link_across(i.e, own.upper, j, axis, own_law, by_pressure, flags);
      mask_links<is_plain>(above, up);
    }
    carried low{zero<vec>(), zero<spin>()};
    if (is_plain || below != 0) low = load_lower(from, pack, axis, below);
    sum = P::wrench_across(sum, up, low, own.arm, axis, own_law, flags);
    // The carry buffer may be the same as `from`, which has been read.
    if (is_plain || above != 0)
      store_carry(carry + std::ptrdiff_t(pack) * carry_size, P::carried_by(up, flags));
  }

  template <bool is_plain>
  wrench links_x(const prepared& i, const prepared& next, const Stored& own_pressure,
                 const Stored& next_pressure, const int* links, simd::LaneMask mask,
                 carried& previous) const {
    const axis_law own_law = law(0, links);
    element j{};
    vec lower, upper;
    if constexpr (terms.is_material) {
      j = from_above<kind>(i.e, next.e);
      lower = upper = i.e.u;
    } else {
      lower = from_above<kind>(i.lower_x, next.lower_x);
      upper = P::upper_face(i.pull, i.x);
      if constexpr (terms.is_damped) j.w = from_above<kind>(i.e.w, next.e.w);
      if constexpr (terms.is_bending) j.q = from_above<kind>(i.e.q, next.e.q);
    }
    const auto by_pressure =
        between(own_pressure, from_above<kind>(own_pressure, next_pressure), 0);
    exchange up = P::link_exchange(i.e, upper, j, lower, 0, own_law, by_pressure, flags);
    mask_links<is_plain>(mask, up);
    const carried own = P::carried_by(up, flags);
    carried low{zero<vec>(), zero<spin>()};
    low.force = from_below<kind>(previous.force, own.force);
    if constexpr (terms.has_couples()) low.couple = from_below<kind>(previous.couple, own.couple);
    previous = own;
    return P::wrench_of_x(i, up, low, own_law, flags);
  }

  R signal(int n) const {
    if constexpr (is_ensemble)
      return simd::load(task.signals + std::ptrdiff_t(n) * W);
    else
      return R(task.signals[n]);
  }
  void apply_wrenches(int pack, wrench& sum) const {
    for (int n = 0; n < task.applied->pattern_count; ++n) {
      const auto& pattern = task.applied->patterns[n];
      if (unsigned(pack - pattern.first) >= unsigned(pattern.packs)) continue;
      const R value = signal(pattern.signal) * R(body.inverse_unit);
      const T* p = pattern.values + std::ptrdiff_t(pack - pattern.first) * wrench_components * W;
      const auto add = [&](R& c) { c = simd::fma(value, simd::load(p), c), p += W; };
      each_component(sum.force, add);
      each_component(sum.moment, add);
    }
  }
  /// Rows with few terms have no code for a frame that rotates, and none for elements that differ
  /// in mass (needed_terms).
  static constexpr bool has_rare_terms = P::of_model == Model::spatial && terms.is_full();
  /// An element of r times the mass and inertia of its body moves as if 1 / r of the wrench acted
  /// on the body's own element.
  void divide_by_ratio(int pack, wrench& sum) const {
    const R inverse = simd::load(task.inverse_ratios + std::ptrdiff_t(pack) * W);
    const auto divide = [&](R& c) { c = c * inverse; };
    each_component(sum.force, divide);
    each_component(sum.moment, divide);
  }
  void turn_frame(int pack, const element& e, const spin& inertia, const spin& inverse_inertia,
                  wrench& sum, spin& turn) const {
    const auto part = [&](int first) {
      return components<spin>([&](int axis) { return signal(body.frame_signal + first + axis); });
    };
    const typename P::frame_turn frame{part(0), part(3)};
    const vec rest = load_at<vec>(task.rest + std::ptrdiff_t(pack) * P::vec_size * W);
    sum.force = P::frame_force(e, rest, frame, R(body.mass), sum.force);
    turn = P::turn_in_frame(sum.moment, e, frame, inertia, inverse_inertia);
  }
  void hold_clamped(int pack, vec& force, spin& turn) const {
    if (task.applied->free_lanes == nullptr) return;
    const simd::LaneMask* mask =
        task.applied->free_lanes + std::ptrdiff_t(pack - task.applied->first) * wrench_components;
    const auto hold = [&](R& c) { c = simd::keep(*mask++, c); };
    each_component(force, hold);
    each_component(turn, hold);
  }
  /// A scalar inertia is the same about every axis. A planar model has only the inertia about z.
  UpdateScales<R> update_scales() const {
    const R turn_scale = terms.is_gyroscopic ? R(T(1)) : R(body.inverse_inertia[2]);
    if constexpr (is_ensemble)
      return {simd::load(task.betas), R(body.inverse_mass), turn_scale};
    else
      return {R(task.beta), R(body.inverse_mass), turn_scale};
  }
  /// The lanes of a check (RowUpdate::check) that count.
  R checked(const R& check) const {
    if constexpr (is_ensemble)
      return simd::keep(*task.live_lanes, check);
    else
      return check;
  }

  carried link_before() const {
    if (kind == LaneKind::neighbours && task.from_x != nullptr) return load_carry(task.from_x);
    return {zero<vec>(), zero<spin>()};
  }
  /// Computes only the link from a piece of a cut row to the next one, into its carry buffer.
  void prime_x() const {
    const int last = task.packs - 1;
    carried previous{zero<vec>(), zero<spin>()};
    const T* const pack = task.in + std::ptrdiff_t(last) * task.stride;
    links_x<false>(prepare(pack), prepare(task.ahead), load_pressure(pack),
                   load_pressure(task.ahead), links_of(last), task.masks[last].link_x, previous);
    store_carry(task.carry_x, previous);
  }
  /// Computes only the links across `axis` from this row to the upper one, into the carry buffer.
  void prime(const int axis) const {
    for (int pack = 0; pack < task.packs; ++pack) {
      const simd::LaneMask above = axis == 1 ? task.masks[pack].link_y : task.masks[pack].link_z;
      if (above == 0) continue;
      const std::ptrdiff_t place = std::ptrdiff_t(pack) * task.stride;
      const T* const upper = axis == 1 ? task.upper_y : task.upper_z;
      const element i = load_at<element>(task.in + place);
      const element j = load_upper(upper, pack, task.stride, axis);
      const axis_law own_law = law(axis, links_of(pack));
      const auto by_pressure = between(load_pressure(task.in + place),
                                       load_upper_pressure(upper, pack, task.stride, axis), axis);
      exchange up = P::link_across(i, P::upper_across(i, axis, own_law, flags), j, axis, own_law,
                                   by_pressure, flags);
      mask_links(above, up);
      store_carry((axis == 1 ? task.carry_y : task.carry_z) + std::ptrdiff_t(pack) * carry_size,
                  P::carried_by(up, flags));
    }
  }

  /// Calls update(place, element, force, turn) for every pack of the row.
  /// @tparam fixed_fields  numbers an element in a pack of any row; any_fields: the task says
  template <int fixed_fields = any_fields, class Update>
  void run(Update&& update) const {
    // Local copies: stores of packs may alias anything, so the compiler would read members through
    // a reference again for every pack.
    const PackMasks* all_masks = task.masks;
    const T *const in = task.in, *const upper_y = task.upper_y, *const upper_z = task.upper_z;
    T *const carry_y = task.carry_y, *const carry_z = task.carry_z;
    const T *const from_y = task.from_y, *const from_z = task.from_z;
    const int applied_first = task.applied != nullptr ? task.applied->first : 0;
    const int applied_packs = task.applied != nullptr ? task.applied->packs : 0;
    const int packs = task.packs;
    const std::ptrdiff_t stride = fixed_fields != any_fields ? fixed_fields * W : task.stride;
    const bool is_accelerated = body.is_accelerated;
    const vec frame = components<vec>([&](int axis) { return signal(axis); });
    const spin inertia = components<spin>([&](int axis) { return R(body.inertia[axis]); }),
               inverse_inertia =
                   components<spin>([&](int axis) { return R(body.inverse_inertia[axis]); });
    const typename P::tie_law tie{R(body.tie_k), R(body.tie_d), R(body.tie_k2_rot),
                                  R(body.tie_d_rot)};
    prepared next = prepare(in);
    alignas(64) T places[2][std::size_t(parked_size)];
    if constexpr (is_parked) park(places[0], next);
    carried previous = link_before();
    const T* const ahead = task.ahead;
    const char* fetch = task.fetch;
    const int fetch_lines = task.fetch_lines;
    const auto one_pack = [&]<path taken>(const int pack, const bool is_applied,
                                          std::integral_constant<path, taken>) {
      constexpr bool is_plain = taken != general_path;
      const PackMasks& masks = all_masks[pack];
      const int* const links = links_of(pack);
      const std::ptrdiff_t place = std::ptrdiff_t(pack) * stride;
      // Unlikely, because the compiler then spills less; the loop also keeps it from moving what
      // the copies share to a place before their branch (README.md).
      if (fetch_lines > 0) [[unlikely]]
        for (int line = fetch_lines; line > 0; --line, fetch += 64) simd::fetch(fetch);
      prepared i = next;
      i.e = load_at<element>(in + place);
      next = prepare(pack + 1 < packs ? in + place + stride : ahead);
      const auto read_again = [&] {
        if constexpr (is_parked) {
          // Fence for the compiler, which would otherwise keep earlier loads and spill them.
          std::atomic_signal_fence(std::memory_order_acq_rel);
          i = parked(places[pack & 1], in + place);
        }
      };
      if constexpr (is_parked) park(places[~pack & 1], next);
      read_again();
      const Stored own_pressure = load_pressure(in + place);
      wrench sum = links_x<taken == plane_path>(
          i, next, own_pressure, load_pressure(pack + 1 < packs ? in + place + stride : ahead),
          links, masks.link_x, previous);
      read_again();
      if constexpr (P::axes > 1)
        add_across<is_plain>(i, own_pressure, 1, masks.link_y, masks.below_y, upper_y, carry_y,
                             from_y, pack, links, stride, sum);
      if constexpr (taken == solid_path) read_again();
      if constexpr (P::axes > 2 && taken != plane_path)
        add_across<is_plain>(i, own_pressure, 2, masks.link_z, masks.below_z, upper_z, carry_z,
                             from_z, pack, links, stride, sum);
      sum = P::wrench_finished(sum, i, laws[0], tie, flags);
      if (is_applied) apply_wrenches(pack, sum);
      if constexpr (has_rare_terms)
        if (task.inverse_ratios != nullptr) divide_by_ratio(pack, sum);
      if (!is_plain && is_accelerated) sum.force = P::vec_axpy(R(body.mass), frame, sum.force);
      read_again();
      spin turn = P::turn(sum.moment, i.e, inertia, inverse_inertia, terms.is_gyroscopic);
      if constexpr (has_rare_terms)
        if (!is_plain && body.frame_signal > 0)
          turn_frame(pack, i.e, inertia, inverse_inertia, sum, turn);
      if (is_applied) hold_clamped(pack, sum.force, turn);
      update(place, i.e, sum.force, turn);
    };
    for (int pack = 0; pack < packs; ++pack) {
      const bool is_applied = unsigned(pack - applied_first) < unsigned(applied_packs);
      const path taken = has_plain_path && !is_applied && !is_accelerated ? path_of(all_masks[pack])
                                                                          : general_path;
      if (taken == plane_path) {
        one_pack(pack, false, std::integral_constant<path, plane_path>{});
      } else if (has_solid_path && taken == solid_path) {
        if constexpr (has_solid_path)
          one_pack(pack, false, std::integral_constant<path, solid_path>{});
      } else {
        if constexpr (has_path_fence) std::atomic_signal_fence(std::memory_order_acq_rel);
        one_pack(pack, is_applied, std::integral_constant<path, general_path>{});
      }
    }
    if (kind == LaneKind::neighbours && task.carry_x != nullptr)
      store_carry(task.carry_x, previous);
  }
};

} // namespace dss
DSS_INLINE_END
