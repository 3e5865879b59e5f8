#include "variants/engine/packed_rows.hpp"

#include "solver/model/needed_terms.hpp"
#include "variants/engine/packs.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace dss {

RowShape row_shape(Model model, const Terms& need) {
  for (const Terms& terms : compiled_terms) {
    if (!is_compiled(model, terms) || !terms.covers(need)) continue;
    const ModelDescriptor& layout = descriptor(model);
    const int all = int(layout.wrench.size());
    return {terms, terms.has_couples() ? all : layout.vec_size(),
            int(layout.fields.size()) + (terms.is_velocity_dependent() ? all : 0),
            pressure_parts(model, terms).count()};
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
  const std::size_t number = packed.filled.number_of(element), r = row_of(packed.lattice, number);
  Place place{r, 0, 0};
  const Row& row = packed.lattice.rows[r];
  const std::size_t end = r + 1 < packed.rows.size() ? packed.lattice.rows[r + 1].first_element
                                                     : packed.lattice.element_count;
  if (end - row.first_element == std::size_t(row.x_end - row.x_begin)) { // no holes
    const int x = row.x_begin + int(number - row.first_element);
    return {r, x / W - packed.rows[r].first_pack, x % W};
  }
  each_cell(packed.lattice, row, [&](std::size_t e, int x) {
    if (e == number) place.pack = x / W - packed.rows[r].first_pack, place.lane = x % W;
  });
  return place;
}

static std::vector<RowCosts> costs_of(const Problem& problem, int lanes) {
  std::vector<RowCosts> costs;
  for (const Body& body : problem.bodies) costs.push_back(row_costs(body.law, lanes));
  return costs;
}

template <class T, int W>
PackedRows<T, W>::PackedRows(const Problem& problem, Model model, const Part* part, Memory& where,
                             const Ensemble* ensemble, RowForm furthest, Lattice pieces)
    : memory(where), cut(std::move(pieces)), cells(is_cut()              ? cut
                                                   : ensemble == nullptr ? problem.lattice
                                                                         : ensemble->lattice),
      filled(cells, W, costs_of(problem, W), is_cut() ? RowForm::cells : furthest),
      lattice(filled.lattice()), layout(descriptor(model)), rows(lattice.rows.size()),
      own_end(int(rows.size())), part_(part),
      members_(ensemble != nullptr && !ensemble->members.empty() ? ensemble->members
                                                                 : std::vector{&problem}),
      applied_index_(lattice.rows.size(), -1) {
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
    packs_across = std::max(packs_across, pack_across(int(r)) + packed.packs);
    max_packs = std::max(max_packs, packed.packs);
    if (filled.form(row) != RowForm::merged) tiled_packs = std::max(tiled_packs, packed.packs);
  }
  set_place_sizes();
  mark_links();
  set_link_constants();
  set_pressures();
  if constexpr (W == simd::lanes<T>) maps_ = LaneMaps<T>(filled, cells); // only these are filled
  for (std::size_t r = 0; r < rows.size(); ++r) rows[r].maps = maps_.of_row(r);
  apply_loads();
  apply_face_strains();
  place_at_rest();
  set_mass_ratios();
  apply_extra_links(problem);
  apply_clamps();
  hand_out_applied();
}

/// Pieces with the same number have places of the same size, so that there are few sizes.
template <class T, int W>
void PackedRows<T, W>::set_place_sizes() {
  std::vector<int> stage(cut.cuts.size() + 1), links(stage.size()); // of each piece
  const auto piece_of = [&](std::size_t r) {
    return is_cut() ? std::size_t(cut.piece_of(lattice.rows[r].x_begin)) : 0;
  };
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const std::size_t n = piece_of(r);
    stage[n] = std::max(stage[n], rows[r].packs);
    links[n] = std::max(links[n], pack_across(int(r)) + rows[r].packs);
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    stage_sizes.push_back(stage[piece_of(r)]);
    links_sizes.push_back(links[piece_of(r)]);
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
    pressure_fields = std::max(pressure_fields, shape.pressure_fields);
  }
}

template <class T, int W>
void PackedRows<T, W>::find_layers() {
  row_layer_.assign(rows.size(), UINT8_MAX);
  has_halo_.assign(rows.size(), false);
  for (std::size_t r = 0; r < rows.size(); ++r)
    each_element(int(r), [&](std::size_t element, int) {
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
  const auto has_halo = [&](int read) { return read >= 0 && has_halo_[std::size_t(read)]; };
  for (const int axis : {0, 1, 2})
    if (has_halo(r.lower(axis)) || has_halo(r.upper(axis))) return true;
  return has_halo(row);
}

template <class T, int W>
std::optional<std::size_t> PackedRows<T, W>::first_failed(int row, const T* packs, int fields,
                                                          int member) const {
  std::optional<std::size_t> failed;
  each_element(row, [&](std::size_t element, int x) {
    if ((failed && *failed < element) || x % lattice.x_stride != member) return;
    if (part_ != nullptr && part_->layer[element] > 0) return;
    const T* lane =
        packs + std::ptrdiff_t(x / W - rows[std::size_t(row)].first_pack) * fields * W + x % W;
    // The pressures are of another state: the input of a stage.
    for (int f = 0; f < fields - pressure_fields; ++f)
      if (!std::isfinite(lane[f * W])) failed = element;
  });
  return failed;
}

template <class T, int W>
void PackedRows<T, W>::mark_links() {
  for (std::size_t r = 0; r < rows.size(); ++r) {
    std::vector<PackMasks> of_row(std::size_t(rows[r].packs));
    filled.each_element(int(r), [&](const Row& row, int x, int place) {
      const auto links_to = [&](int other) {
        return other >= 0 && cells.is_present(cells.rows[std::size_t(other)], x);
      };
      PackMasks& masks = of_row[std::size_t(place / W - rows[r].first_pack)];
      const auto bit = simd::LaneMask(1u << (place % W));
      if (cells.has_link_x(row, x)) masks.link_x |= bit;
      if (links_to(row.upper_y)) masks.link_y |= bit;
      if (links_to(row.upper_z)) masks.link_z |= bit;
      if (links_to(row.lower_y)) masks.below_y |= bit;
      if (links_to(row.lower_z)) masks.below_z |= bit;
    });
    rows[r].masks = masks_.insert(std::move(of_row)).first->data();
  }
}

template <class T, int W>
template <class Table>
void PackedRows<T, W>::add_all_packs(Table& table) const {
  for (std::size_t r = 0; r < rows.size(); ++r)
    table.add_packs(lattice.rows[r].body, rows[r].packs, [&](auto&& visit) {
      each_element(int(r), [&](std::size_t element, int x) {
        visit(element / members_.size(), x - rows[r].first_pack * W);
      });
    });
}

template <class T, int W>
void PackedRows<T, W>::set_link_constants() {
  if (links_.is_mixed()) add_all_packs(links_);
  links_.finish();
  if (links_.lanes().empty()) return;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    rows[r].links = &links_.lanes()[links_.is_mixed() ? 0 : 3 * std::size_t(lattice.rows[r].body)];
    if (links_.is_mixed()) rows[r].link_index = &links_.index()[rows[r].pack_offset * links_.faces];
  }
}

template <class T, int W>
void PackedRows<T, W>::set_pressures() {
  if (pressure_fields == 0) return;
  add_all_packs(pressures_);
  pressures_.finish();
  for (const PackedRow<T>& row : rows)
    row_pressures_.push_back({pressures_.lanes().data(), &pressures_.index()[row.pack_offset]});
  for (std::size_t r = 0; r < rows.size(); ++r)
    if (rows[r].shape.pressure_fields > 0) rows[r].pressure = &row_pressures_[r];
}

template <class T, int W>
std::size_t PackedRows<T, W>::bytes() const {
  std::size_t sum = rows.size() * sizeof(PackedRow<T>) + applied_index_.size() * sizeof(int) +
                    filled.bytes() + maps_.bytes() + links_.bytes();
  sum += (stage_sizes.size() + links_sizes.size()) * sizeof(int) + cut.rows.size() * sizeof(Row) +
         cut.present.size();
  for (const auto& masks : masks_) sum += masks.size() * sizeof(PackMasks);
  sum += member_bodies_.size() * sizeof(member_bodies_[0]);
  for (const auto& row : applied_) {
    sum += sizeof(AppliedRow) + row->free_lanes.size() * sizeof(simd::LaneMask);
    for (const Buffer<T>& values : row->values) sum += values.bytes();
  }
  for (const Buffer<T>& wrench : extra_) sum += wrench.bytes();
  for (const Buffer<T>& places : rest_) sum += places.bytes();
  for (const Buffer<T>& ratios : inverse_ratios_) sum += ratios.bytes();
  sum += pressures_.bytes() + row_pressures_.size() * sizeof(row_pressures_[0]);
  for (const auto& row : face_strains_)
    for (std::size_t n = 0; row != nullptr && n < row->values.size(); ++n)
      sum += sizeof(AppliedRow) + row->values[n].bytes();
  return sum;
}

#define DSS_INSTANTIATE(T, W)                                                                      \
  template class PackedRows<T, W>;                                                                 \
  template Place place_of(const PackedRows<T, W>&, std::size_t);
DSS_EACH_PACK(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE

} // namespace dss
