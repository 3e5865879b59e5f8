#pragma once
/// Converts the state of an executor, which is held as rows of packs: to and from fields, to and
/// from what a method keeps, and into layouts of messages.
#include "solver/numerics/method.hpp"
#include "variants/api/halo.hpp"
#include "variants/api/kept_state.hpp"
#include "variants/engine/row_storage.hpp"

#include <functional>
#include <span>

namespace dss {

/// Reads and writes the state through the addresses of its rows.
template <class T, int W = simd::lanes<T>>
class StateRows {
public:
  using RowAddress = std::function<T*(int)>;
  /// @param packed, method  outlive this object
  /// @param dt              step [s]; of an ensemble: of each member
  /// @param row             function from a row's number to the address of its present state
  StateRows(const PackedRows<T, W>& packed, const Method& method, Precision precision,
            std::span<const double> dt, RowAddress row)
      : packed_(packed), method_(method), precision_(precision),
        storage_(packed, method, precision), row_(std::move(row)) {
    for (const double step : dt) half_steps_.push_back(T(step / 2));
  }

  bool is_staggered() const { return method_.is_staggered(); }
  const RowStorage& storage() const { return storage_; }
  /// Numbers that a pack of the state holds for each element.
  int stored_fields() const { return storage_.stored(); }

  /// As Executor::write and Executor::read.
  /// @param end_rates  null, or rates at the end of a staggered method's last step, in plain packs.
  ///   Its stored velocities are those of the last half step; then v_n = v_{n-1/2} + (h / 2) a(x_n,
  ///   p_n), where p is the predicted velocity.
  void write(std::size_t first, std::span<const double> fields);
  void read(std::size_t first, std::span<double> fields, const T* end_rates);
  /// As Executor::save and restore. `is_started`: a staggered method has half-step velocities.
  int kept_fields() const { return kept_field_count(method_, precision_); }
  void save(std::size_t first, std::span<double> kept, bool is_started);
  bool restore(std::size_t first, std::span<const double> kept);

  /// Numbers that a plain pack holds for each element: the model's fields and its pressure.
  int plain_fields() const { return packed_.fields() + storage_.pressures; }
  /// Size of a buffer of plain packs [numbers], row after row. One readable pack follows the last.
  std::size_t plain_size() const;
  std::size_t plain_offset(int r) const {
    return packed_.rows[std::size_t(r)].pack_offset * std::size_t(plain_fields() * W);
  }
  void copy_plain(T* plain) { copy_plain(plain, row_); }
  void copy_plain(T* plain, const RowAddress& row);
  /// Copies the model's fields of a row that is kept at `row`.
  void copy_plain_row(int r, const T* row, T* plain) const;
  /// Converts plain rates to all 13 fields of all elements.
  void rates_out(const T* rates, std::span<double> out) const;
  /// Starts a staggered method: moves the velocities back by half a step, v_{-1/2} = v_0 - (h / 2)
  /// a_0. The predicted velocities p_0 = v_0 are in the rows already.
  void start(const T* rates);
  /// The same of one row, from its own rates.
  void start_row(int r, const T* rates);

  /// Where elements lie in rows. The message has the order of whole packs in memory: pack after
  /// pack, in it field after field, in it the lanes of the elements.
  /// @param copy_row  (row) -> two places of the row, the second may be null
  /// @param is_own    (element) -> whether it is an own element of the part
  template <class CopyRow, class IsOwn>
  HaloLayout layout(std::span<const std::size_t> elements, CopyRow&& copy_row,
                    IsOwn&& is_own) const;

private:
  /// Calls visit(element, lane pointer to the first field) for elements [first, first + count).
  template <class Visit>
  void each_element(std::size_t first, std::size_t count, Visit&& visit);
  /// Calls visit(index in the model's fields, index of the half-step velocity) for each velocity
  /// and spin component.
  template <class Visit>
  void each_velocity(Visit&& visit) const;
  const T* plain_lane(const T* plain, std::size_t r, int x) const {
    const std::size_t pack =
        packed_.rows[r].pack_offset + std::size_t(x / W - packed_.rows[r].first_pack);
    return plain + pack * std::size_t(plain_fields() * W) + x % W;
  }

  T half_step(int lane) const { return half_steps_[std::size_t(lane) % half_steps_.size()]; }
  /// Gets the fields of an element that the model has.
  void fields_out(const T* lane, std::span<double> out) const;
  /// A number in double precision, including its low part. `f` is its index in the model's fields.
  double value(const T* lane, int f, int stored_at) const {
    return double(lane[stored_at * W]) + (storage_.is_compensated() ? double(*low(lane, f)) : 0);
  }
  /// Stores a number, and its low part if there is one.
  void keep(double value, T* lane, int f, int stored_at) const {
    lane[stored_at * W] = T(value);
    if (storage_.is_compensated()) *low(lane, f) = T(value - double(T(value)));
  }
  template <class Lane>
  Lane low(Lane lane, int f) const {
    return lane + (storage_.first_low() + f) * W;
  }

  const PackedRows<T, W>& packed_;
  const Method& method_;
  const Precision precision_;
  const RowStorage storage_;
  std::vector<T> half_steps_; ///< [s]; one, or one a lane
  const RowAddress row_;
};

template <class T, int W>
template <class CopyRow, class IsOwn>
HaloLayout StateRows<T, W>::layout(std::span<const std::size_t> elements, CopyRow&& copy_row,
                                   IsOwn&& is_own) const {
  const std::size_t number = sizeof(T), fields = std::size_t(stored_fields());
  HaloLayout layout;
  const auto add = [&](T* at, std::size_t offset, std::size_t count) {
    auto& pieces = layout.pieces;
    auto* const bytes = reinterpret_cast<std::byte*>(at);
    if (!pieces.empty() && pieces.back().at + pieces.back().count == bytes &&
        pieces.back().offset + pieces.back().count == offset)
      pieces.back().count += count;
    else
      pieces.push_back({bytes, offset, count});
  };
  for (std::size_t from = 0, to = 0; from < elements.size(); from = to) {
    const Place place = place_of(packed_, elements[from]);
    std::vector<int> lanes;
    for (; to < elements.size(); ++to) {
      const Place other = place_of(packed_, elements[to]);
      if (other.row != place.row || other.pack != place.pack) break;
      lanes.push_back(other.lane);
    }
    const std::pair<T*, T*> rows = copy_row(int(place.row));
    T *const first = rows.first, *const twin = rows.second;
    const bool own = is_own(elements[from]);
    for (T* const target : {own && twin != nullptr ? twin : first, own ? nullptr : twin}) {
      if (target == nullptr) continue;
      T* const pack = target + std::size_t(place.pack) * fields * W;
      for (std::size_t f = 0; f < fields; ++f)
        for (std::size_t l = 0; l < lanes.size(); ++l)
          add(pack + f * W + lanes[l], layout.size + (f * lanes.size() + l) * number, number);
    }
    layout.size += fields * lanes.size() * number;
  }
  return layout;
}

} // namespace dss
