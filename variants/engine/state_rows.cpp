#include "variants/engine/state_rows.hpp"

#include "solver/model/rotation_vector.hpp"
#include "variants/engine/packs.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace dss {

template <class T, int W>
template <class Visit>
void StateRows<T, W>::each_element(std::size_t first, std::size_t count, Visit&& visit) {
  packed_.each_element(first, count, [&](std::size_t element, std::size_t r, int x) {
    const std::ptrdiff_t pack = x / W - packed_.rows[r].first_pack;
    visit(element, row_(int(r)) + pack * stored_fields() * W + x % W);
  });
}

template <class T, int W>
template <class Visit>
void StateRows<T, W>::each_velocity(Visit&& visit) const {
  int half = packed_.fields();
  for (int f = 0; f < packed_.fields(); ++f) {
    const Field field = packed_.layout.fields[std::size_t(f)];
    if ((field >= vx && field <= vz) || field >= wx) visit(f, storage_.is_predicted() ? half++ : f);
  }
}

template <class T, int W>
void StateRows<T, W>::fields_out(const T* lane, std::span<double> out) const {
  for (int f = 0; f < packed_.fields(); ++f)
    out[std::size_t(packed_.layout.fields[std::size_t(f)])] = value(lane, f, f);
}

template <class T, int W>
void StateRows<T, W>::write(std::size_t first, std::span<const double> fields) {
  each_element(first, fields.size() / field_count, [&](std::size_t element, T* lane) {
    std::array<double, field_count> from;
    std::copy_n(&fields[(element - first) * field_count], from.size(), from.begin());
    if (packed_.layout.has_vectors) to_rotation_vector(from);
    for (int f = 0; f < packed_.fields(); ++f)
      keep(from[packed_.layout.fields[std::size_t(f)]], lane, f, f);
  });
}

// v = v_half + (h / 2) a is rounded once, by a fused multiply-add, so that all variants agree.
template <class T, int W>
void StateRows<T, W>::read(std::size_t first, std::span<double> fields, const T* end_rates) {
  std::fill(fields.begin(), fields.end(), 0.0);
  each_element(first, fields.size() / field_count, [&](std::size_t element, T* lane) {
    const std::span<double> out = fields.subspan((element - first) * field_count, field_count);
    fields_out(lane, out);
    if (packed_.layout.has_vectors) to_quaternion(out);
    if (end_rates == nullptr) return;
    const Place place = place_of(packed_, element);
    const std::size_t pack = packed_.rows[place.row].pack_offset + std::size_t(place.pack);
    const T* const rates = end_rates + pack * std::size_t(plain_fields() * W) + place.lane;
    const T half = half_step(place.lane);
    each_velocity([&](int f, int at) {
      out[std::size_t(packed_.layout.fields[std::size_t(f)])] =
          storage_.is_compensated() ? value(lane, f, at) + double(half) * double(rates[f * W])
                                    : double(simd::fma(half, rates[f * W], lane[at * W]));
    });
  });
}

template <class T, int W>
void StateRows<T, W>::save(std::size_t first, std::span<double> kept, bool is_started) {
  const std::size_t count = std::size_t(kept_fields());
  std::fill(kept.begin(), kept.end(), 0.0);
  each_element(first, kept.size() / count, [&](std::size_t element, const T* lane) {
    const std::span<double> out = kept.subspan((element - first) * count, count);
    for (int f = 0; f < packed_.fields(); ++f)
      out[std::size_t(packed_.layout.fields[std::size_t(f)])] = double(lane[f * W]);
    for (int f = 0; f < storage_.lows; ++f)
      out[std::size_t(kept_first_low(method_) + packed_.layout.fields[std::size_t(f)])] =
          double(*low(lane, f));
    if (!is_staggered()) return;
    each_velocity([&](int f, int half) {
      out[std::size_t(kept_half_velocity(packed_.layout.fields[std::size_t(f)]))] =
          double(lane[half * W]);
    });
    out[kept_is_started] = is_started;
  });
}

template <class T, int W>
bool StateRows<T, W>::restore(std::size_t first, std::span<const double> kept) {
  const std::size_t count = std::size_t(kept_fields());
  bool is_started = false;
  each_element(first, kept.size() / count, [&](std::size_t element, T* lane) {
    const double* from = &kept[(element - first) * count];
    for (int f = 0; f < packed_.fields(); ++f)
      lane[f * W] = T(from[packed_.layout.fields[std::size_t(f)]]);
    for (int f = 0; f < storage_.lows; ++f)
      *low(lane, f) = T(from[kept_first_low(method_) + packed_.layout.fields[std::size_t(f)]]);
    if (!is_staggered()) return;
    each_velocity([&](int f, int half) {
      lane[half * W] = T(from[kept_half_velocity(packed_.layout.fields[std::size_t(f)])]);
    });
    is_started = from[kept_is_started] != 0;
  });
  return is_started;
}

template <class T, int W>
std::size_t StateRows<T, W>::plain_size() const {
  return packed_.readable_packs() * std::size_t(plain_fields() * W);
}

template <class T, int W>
void StateRows<T, W>::copy_plain(T* plain, const RowAddress& row) {
  for (int r = 0; r < int(packed_.rows.size()); ++r)
    copy_plain_row(r, row(r), plain + plain_offset(r));
}

template <class T, int W>
void StateRows<T, W>::copy_plain_row(int r, const T* row, T* plain) const {
  const std::size_t fields_size = std::size_t(packed_.fields() * W),
                    plain_size = std::size_t(plain_fields() * W),
                    stored_size = std::size_t(stored_fields() * W);
  for (int p = 0; p < packed_.rows[std::size_t(r)].packs; ++p)
    std::copy_n(row + std::size_t(p) * stored_size, fields_size,
                plain + std::size_t(p) * plain_size);
}

template <class T, int W>
void StateRows<T, W>::rates_out(const T* rates, std::span<double> out) const {
  std::fill(out.begin(), out.end(), 0.0);
  for (std::size_t r = 0; r < packed_.rows.size(); ++r)
    packed_.each_element(int(r), [&](std::size_t element, int x) {
      const T* const lane = plain_lane(rates, r, x);
      const std::span<double> of_element = out.subspan(element * field_count, field_count);
      for (int f = 0; f < packed_.fields(); ++f)
        of_element[std::size_t(packed_.layout.fields[std::size_t(f)])] = double(lane[f * W]);
      if (!packed_.layout.has_vectors) return;
      std::array<double, field_count> state{};
      const std::ptrdiff_t pack = x / W - packed_.rows[r].first_pack;
      fields_out(row_(int(r)) + pack * stored_fields() * W + x % W, state);
      to_quaternion_rates(state, of_element);
    });
}

template <class T, int W>
void StateRows<T, W>::start(const T* rates) {
  for (int r = 0; r < int(packed_.rows.size()); ++r) start_row(r, rates + plain_offset(r));
}

template <class T, int W>
void StateRows<T, W>::start_row(int r, const T* rates) {
  T* const row = row_(r);
  for (int p = 0; p < packed_.rows[std::size_t(r)].packs; ++p)
    for (int l = 0; l < W; ++l) {
      T* const lane = row + std::ptrdiff_t(p) * stored_fields() * W + l;
      const T* const rate = rates + std::ptrdiff_t(p) * plain_fields() * W + l;
      const T half = half_step(l);
      each_velocity([&](int f, int at) {
        if (storage_.is_compensated())
          keep(value(lane, f, f) - double(half) * double(rate[f * W]), lane, f, at);
        else
          lane[at * W] = simd::fma(-half, rate[f * W], lane[f * W]);
      });
    }
}

#define DSS_INSTANTIATE(T, W) template class StateRows<T, W>;
DSS_EACH_PACK(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE

} // namespace dss
