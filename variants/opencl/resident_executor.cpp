#include "variants/opencl/resident_executor.hpp"

#include "variants/engine/packs.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss::opencl {

template <class T, int W>
ResidentExecutor<T, W>::ResidentExecutor(const Setup& setup, const Device& device,
                                         const Layout& layout)
    : setup_(setup), part_(part_with_neighbours(setup.part)),
      problem_(setup.problem, setup.model, part_ == nullptr ? nullptr : &part_->part, device,
               layout),
      rows_(packed_, setup_.method, setup_.precision, setup_.steps(),
            [this](int r) { return row(r); }),
      halo_rows_(problem_) {
  const PartWorksAlone alone(part_);
  // A GPU computes more work-items at once than there are rows, and a wavefront over all of them
  // would not stay in its caches.
  const bool is_staged = layout.has_items || setup_.method.has_error_stage ||
                         !setup_.problem.extra_links.empty() ||
                         (is_part() && part_->is_every_stage);
  if (is_staged) {
    refuse_tile(setup_,
                layout.has_items ? "a GPU has no wavefront" : "it is computed stage by stage");
    problem_.set_stage_tile(tile_of_rows());
    staged_.emplace(packed_, setup_.method, setup_.dt, rows_.storage(), layout.bands, part_,
                    problem_.stage_tile().is_used());
    add_stages();
  } else {
    make_blocks();
  }
  problem_.add_extra_links(setup_.problem, stored_fields());
  problem_.finish();
  make_kernels();
  sent_.resize(std::size_t(halo_copies())), received_ = sent_;
  if (is_split_) halo_rows_.go_beside();
  warm_up();
}

template <class T, int W>
std::vector<int> ResidentExecutor<T, W>::cut_blocks() {
  const int begin = packed_.own_begin, end = packed_.own_end,
            halo = sweeps_.count() * packed_.reach;
  // With shared memory there is no transfer to hide, and each command costs time (README.md). Own
  // rows that contain halo elements cannot be edges.
  is_split_ = is_part() && part_->is_overlapped && !problem_.is_shared() &&
              end - begin >= 4 * halo &&
              std::ranges::none_of(part_->part.neighbours, [&](const Neighbour& neighbour) {
                return side_of(part_->part, neighbour) == Side::among;
              });
  has_lower_edge_ = is_split_ && begin > 0;
  has_upper_edge_ = is_split_ && end < int(packed_.rows.size());
  packed_.own_begin += has_lower_edge_ ? halo : 0;
  packed_.own_end -= has_upper_edge_ ? halo : 0;
  std::vector<int> cuts = cut_rows(packed_, problem_.layout.bands);
  packed_.own_begin = begin, packed_.own_end = end;
  if (has_lower_edge_) cuts.insert(cuts.begin(), begin);
  if (has_upper_edge_) cuts.push_back(end);
  return cuts;
}

static row_action device_action(RowWork work, row_action of_stage, bool is_pressure) {
  switch (work) {
  case RowWork::stage:
    return of_stage;
  case RowWork::pressure:
    return find_pressure;
  case RowWork::upper_links:
    return prime_of(prime_upper, is_pressure);
  case RowWork::upper_link_y:
    return prime_of(prime_y, is_pressure);
  case RowWork::upper_link_z:
    return prime_of(prime_z, is_pressure);
  case RowWork::upper_link_x: // rows on devices are whole
  case RowWork::extra_link:
  case RowWork::extra_sum:
    break;
  }
  throw std::logic_error("devices compute scenes with extra links stage by stage");
}

template <class T, int W>
void ResidentExecutor<T, W>::make_blocks() {
  const Method& method = setup_.method;
  const int halo = sweeps_.count() * packed_.reach;
  division_.cuts = cut_blocks();
  division_.halo = packed_.stage_halo;
  bands_ = division_.blocks();
  // Several bands would have to copy their halos on the device.
  shape_.steps = bands_ == 1 ? steps_a_pass(packed_, method, 1, division_.halo) : 1;
  blocks_.make(packed_, division_, stored_fields(), shape_.steps * sweeps_.count());
  shape_.form.is_in_row_order = is_part();
  shape_.form.tile = choose_tile(
      packed_, method, rows_.storage(), shape_.steps,
      most_rows_across(packed_.lattice, division_, shape_.form.is_in_row_order, {}), setup_.tile);
  if (!is_part() && bands_ <= problem_.queue.device().compute_units) trials_left_ = 3;
  const Wavefront<T, W> wavefront(packed_, method, setup_.steps(), rows_.storage(),
                                  signal_count(setup_.problem), blocks_, shape_, {});
  for (int band = 0; band < bands_; ++band) {
    add_neighbours(division_.cuts, band, halo);
    for (const int parity : {0, 1}) {
      const int begin = problem_.next_place();
      for (const auto& stage : wavefront.steps()[std::size_t(band)].tasks(parity))
        problem_.add(stage.task, stage.row,
                     device_action(stage.work, stage.task.action, sweeps_.is_pressure(stage.sweep)),
                     stored_fields(),
                     stage.is_published ? blocks_.of(stage.row).published(stage.row, parity ^ 1)
                                        : nullptr,
                     stage.sweep);
      passes_.push_back({{begin, problem_.next_place()}});
    }
  }
}

/// Finds the bands with rows in the halo of this band.
template <class T, int W>
void ResidentExecutor<T, W>::add_neighbours(const std::vector<int>& cuts, int band, int halo) {
  const int begin = cuts[std::size_t(band)] - halo, end = cuts[std::size_t(band) + 1] + halo;
  int first = band, last = band;
  while (first > 0 && cuts[std::size_t(first)] > begin) --first;
  while (last + 1 < bands_ && cuts[std::size_t(last) + 1] < end) ++last;
  neighbours_.push_back({{first, last + 1}});
}

template <class T, int W>
void ResidentExecutor<T, W>::make_kernels() {
  kernel_ = problem_.kernel(problem_.stage_tile().is_used() ? "run_tiles"
                            : staged_                       ? "run_rows"
                                                            : "run_passes");
  failed_ = problem_.queue.make_buffer(std::size_t(1 + 2 * bands_) * sizeof(cl_int));
  if (!staged_) {
    pass_table_ = problem_.table(passes_);
    neighbour_table_ = problem_.table(neighbours_);
    progress_ = problem_.queue.make_buffer(std::size_t(bands_) * sizeof(cl_int));
    return;
  }
  if (setup_.method.has_error_stage) make_error_kernels();
  for (const auto& lists : lists_) list_tables_.push_back(problem_.table(lists));
  for (int parity = 0; problem_.has_extra_links() && parity < (staged_->is_swapped() ? 2 : 1);
       ++parity) {
    for (int stage = 0; stage < setup_.method.stages; ++stage) {
      std::vector<cl_long> starts;
      for (int r = 0; r < int(packed_.rows.size()); ++r)
        starts.push_back(problem_.offset(staged_->stage_row(stage, r)));
      row_starts_.push_back(problem_.table(starts));
    }
    if (staged_->is_swapped()) staged_->swap();
  }
}

template <class T, int W>
void ResidentExecutor<T, W>::warm_up() {
  const opencl::Buffer nothing = problem_.table(std::vector<cl_int2>(std::size_t(bands_)));
  problem_.queue.set_counting(false);
  problem_.set_signals(std::vector<double>(signal_count(setup_.problem)),
                       signal_count(setup_.problem));
  forget_failures();
  if (problem_.stage_tile().is_used()) {
    set_tile_arguments(0, 0, 0);
    problem_.launch_tiles(kernel_);
  } else if (staged_) {
    if (problem_.has_extra_links()) problem_.evaluate_extra_links(row_starts_.front());
    set_stage_arguments(nothing, 0, 0);
    problem_.launch_rows(kernel_, bands_);
    if (setup_.method.has_error_stage) warm_up_error_kernels(nothing);
  } else {
    set_pass_arguments(0);
    run_to(0, false);
  }
  problem_.queue.finish();
  problem_.queue.set_counting(true);
}

template <class T, int W>
T* ResidentExecutor<T, W>::row(int r) {
  return staged_ ? staged_->row(r) : blocks_.row(r, parity_);
}

template <class T, int W>
std::pair<T*, T*> ResidentExecutor<T, W>::copy_row(int copy, int r) {
  if (staged_) return {staged_->copy_row(copy, r), nullptr};
  return blocks_.copy_row(copy, r);
}

/// Ranges of all stored rows. Rows that follow one another in memory are one range.
template <class T, int W>
auto ResidentExecutor<T, W>::state_ranges() -> std::vector<Range> {
  std::vector<Range> ranges;
  const auto add = [&](const T* from, std::size_t count) {
    if (!ranges.empty() && ranges.back().to == from)
      ranges.back().to += count;
    else
      ranges.push_back({from, from + count});
  };
  for (int r = 0; r < int(packed_.rows.size()); ++r) add(row(r), row_size(r));
  for (Block<T, W>& block : blocks_.all())
    for (int r = block.begin; r < block.end && !block.is_remote(); ++r)
      if (block.is_published(r)) add(block.published(r, parity_), row_size(r));
  return ranges;
}

template <class T, int W>
void ResidentExecutor<T, W>::to_host() {
  if (is_on_host_) return;
  problem_.queue.set_counting(false); // transfers of whole states do not count as the method's
  problem_.to_host(state_ranges());
  problem_.queue.set_counting(true);
  is_on_host_ = true;
}

template <class T, int W>
void ResidentExecutor<T, W>::to_device() {
  if (!is_on_host_) return;
  publish_changed();
  problem_.queue.set_counting(false);
  problem_.to_device(is_changed_ ? state_ranges() : std::vector<Range>{});
  problem_.queue.set_counting(true);
  is_on_host_ = is_changed_ = false;
}

/// Publishes the rows that bands read. A state is written in pieces of thousands of elements, so
/// this is done once, after the last piece.
template <class T, int W>
void ResidentExecutor<T, W>::publish_changed() {
  if (is_changed_) blocks_.publish_all(parity_);
}

template <class T, int W>
void ResidentExecutor<T, W>::write(std::size_t first, std::span<const double> fields) {
  stop_leapfrog();
  to_host();
  parity_ = 0;
  rows_.write(first, fields);
  is_changed_ = true;
}

template <class T, int W>
void ResidentExecutor<T, W>::read(std::size_t first, std::span<double> fields) {
  to_host();
  if (is_started_ && end_rates_.empty()) end_rates_ = evaluate(end_signals_);
  rows_.read(first, fields, is_started_ ? end_rates_.data() : nullptr);
}

template <class T, int W>
void ResidentExecutor<T, W>::save(std::size_t first, std::span<double> kept) {
  to_host();
  rows_.save(first, kept, is_started_);
}

template <class T, int W>
void ResidentExecutor<T, W>::restore(std::size_t first, std::span<const double> kept) {
  to_host();
  end_rates_.clear();
  is_started_ = rows_.restore(first, kept);
  is_changed_ = true;
}

/// Rates of plain rows at the present state, which the host has.
template <class T, int W>
std::vector<T> ResidentExecutor<T, W>::evaluate(std::span<const double> signals) {
  // Some drivers compile at the first launch.
  const PartWorksAlone alone(rates_ == nullptr ? part_ : nullptr);
  if (is_part()) {
    const int copy = staged_ ? staged_->current_copy() : parity_;
    send(copy);
    receive(copy);
  }
  if (rates_ == nullptr)
    rates_ = std::make_unique<DeviceRates<T, W>>(setup_.problem, setup_.model,
                                                 is_part() ? &part_->part : nullptr,
                                                 problem_.queue.device(), problem_.layout, true);
  std::vector<T> plain(rows_.plain_size()), rates(plain.size());
  rows_.copy_plain(plain.data());
  rates_->evaluate(plain.data(), signals, rates.data());
  return rates;
}

template <class T, int W>
void ResidentExecutor<T, W>::derivative(std::span<const double> signals, std::span<double> rates) {
  stop_leapfrog();
  to_host();
  rows_.rates_out(evaluate(signals).data(), rates);
}

template <class T, int W>
bool ResidentExecutor<T, W>::repeat_derivative(long times, std::span<double> rates) {
  if (rates_ == nullptr || is_part()) return false;
  std::vector<T> plain(rates.empty() ? 0 : rows_.plain_size());
  rates_->repeat(times, rates.empty() ? nullptr : plain.data());
  if (!rates.empty()) rows_.rates_out(plain.data(), rates);
  return true;
}

template <class T, int W>
void ResidentExecutor<T, W>::stop_leapfrog() {
  if (!is_started_) return;
  std::vector<double> state(packed_.lattice.element_count * field_count);
  read(0, state);
  is_started_ = false;
  end_rates_.clear();
  write(0, state);
}

template <class T, int W>
std::string ResidentExecutor<T, W>::schedule() const {
  const std::string& device = problem_.queue.device().entry.name;
  if (problem_.layout.has_items)
    return fmt::format("on {}: a work-item an element, in packs of {} lanes; {}{}", device, W,
                       stages_text(problem_.stage_tile()), sweeps_.text());
  return fmt::format("on {}: {} bands of rows, work-items of {} lanes; {}{}", device, bands_, W,
                     staged_ ? "stage by stage"
                             : fmt::format("wavefront, reach {}, in place{}", packed_.reach,
                                           tiles_text(shape_.form.tile)),
                     sweeps_.text());
}

template <class T, int W>
DeviceUse ResidentExecutor<T, W>::device_use() const {
  Counts counts = problem_.queue.counts();
  return use_of(problem_, counts += halo_rows_.counts());
}

#define DSS_INSTANTIATE(T, W) template class ResidentExecutor<T, W>;
DSS_EACH_PACK(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE

} // namespace dss::opencl
