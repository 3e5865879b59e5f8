#include "variants/opencl/device_rates.hpp"

#include "variants/engine/packs.hpp"

namespace dss::opencl {

template <class T, int W>
DeviceRates<T, W>::DeviceRates(const Problem& problem, Model model, const Part* part,
                               const Device& device, const Layout& layout, bool is_scaled)
    : device_(problem, model, part, device, layout) {
  PackedRows<T, W>& packed = device_.packed;
  packed.own_begin = 0,
  packed.own_end = int(packed.rows.size()); // halo rows too: the caller knows which rates are valid
  const int fields = packed.fields() + packed.pressure_fields;
  const std::size_t pack_size = std::size_t(fields * W);
  plain_ = dss::Buffer<T>(packed.readable_packs() * pack_size, packed.memory);
  rates_ = dss::Buffer<T>(packed.readable_packs() * pack_size, packed.memory);
  zero_ = dss::Buffer<T>(std::size_t(packed.max_packs + 1) * pack_size, packed.memory);
  const auto row_of = [&](dss::Buffer<T>& rows, int r) {
    return rows.data() + packed.rows[std::size_t(r)].pack_offset * pack_size;
  };
  const auto in = [&](int r) { return row_of(plain_, r); };
  const std::vector<int> cuts =
      cut_rows(packed, layout.has_items ? int(packed.rows.size()) : layout.bands);
  const auto add_band = [&](std::size_t b, bool is_pressure) {
    // Work-items use no carry buffers, so all rows name the same ones.
    if (carry_.empty() || !layout.has_items) carry_.emplace_back(packed);
    CarryRings<T>& carry = carry_.back();
    const int begin = device_.next_place();
    if (cuts[b] > 0 && !layout.has_items)
      each_prime(packed, cuts[b], fields, carry, in, [&](int r, const RowTask<T>& task, int axis) {
        device_.add(task, r, prime_of(axis == 1 ? prime_y : prime_z, is_pressure), fields);
      });
    for (int r = cuts[b]; r < cuts[b + 1]; ++r) {
      RowTask<T> task;
      set_row(task, packed, r, fields, carry, in);
      task.base = zero_.data(); // out = 0 + 1 f
      task.out = is_pressure ? in(r) : row_of(rates_, r);
      task.beta = 1;
      device_.add(task, r,
                  is_pressure ? find_pressure
                  : is_scaled ? plain_stage
                              : bare_rates,
                  fields);
    }
    lists_.back().push_back({{begin, device_.next_place()}});
  };
  for (const bool is_pressure : {true, false}) {
    if (is_pressure && !problem.has_pressure()) continue;
    lists_.emplace_back();
    for (std::size_t b = 0; b + 1 < cuts.size(); ++b) add_band(b, is_pressure);
  }
  device_.add_extra_links(problem, fields);
  device_.finish();
  for (const std::vector<cl_int2>& lists : lists_) list_tables_.push_back(device_.table(lists));
  std::vector<cl_long> starts;
  for (int r = 0; r < int(packed.rows.size()); ++r) starts.push_back(device_.offset(in(r)));
  row_starts_ = device_.table(starts);
  failed_ =
      device_.table(std::vector<cl_int2>(std::size_t(bands()) + 1, cl_int2{{INT_MAX, INT_MAX}}));
  kernel_ = device_.kernel("run_rows");
}

template <class T, int W>
void DeviceRates<T, W>::launch() {
  if (device_.has_extra_links()) device_.evaluate_extra_links(row_starts_);
  for (const opencl::Buffer& lists : list_tables_) {
    cl_uint n = DeviceProblem<T, W>::table_arguments;
    kernel_.set_one(n++, lists);
    kernel_.set_one(n++, device_.signals());
    kernel_.set_one(n++, failed_);
    for (const cl_int value : {0, 0}) kernel_.set_one(n++, value); // first signal and step
    device_.launch_rows(kernel_, bands());
  }
}

template <class T, int W>
void DeviceRates<T, W>::put(const dss::Buffer<T>& buffer, const T* numbers) {
  device_.queue.write(device_.arena(), place(buffer),
                      {reinterpret_cast<const std::byte*>(numbers), buffer.bytes()});
}

template <class T, int W>
void DeviceRates<T, W>::get_rates(T* rates) {
  device_.queue.read(device_.arena(), place(rates_),
                     {reinterpret_cast<std::byte*>(rates), rates_.bytes()});
}

template <class T, int W>
void DeviceRates<T, W>::evaluate(const T* plain, std::span<const double> signals, T* rates) {
  device_.set_signals(signals, signals.size());
  put(plain_, plain);
  launch();
  get_rates(rates);
}

template <class T, int W>
void DeviceRates<T, W>::repeat(long times, T* rates) {
  if (rates != nullptr) put(rates_, std::vector<T>(size()).data());
  for (long n = 0; n < times; ++n) launch();
  if (rates != nullptr)
    get_rates(rates);
  else
    device_.queue.finish();
}

#define DSS_INSTANTIATE(T, W) template class DeviceRates<T, W>;
DSS_EACH_PACK(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE

} // namespace dss::opencl
