/// Steps of the resident executor: launches, the halos between them, and their outcome.
#include "variants/api/tried_steps.hpp"
#include "variants/engine/packs.hpp"
#include "variants/opencl/resident_executor.hpp"

#include <algorithm>
#include <utility>

namespace dss::opencl {

template <class T, int W>
Outcome ResidentExecutor<T, W>::advance(long steps, std::span<const double> signals) {
  if (steps <= 0) return {};
  if (setup_.method.has_error_stage) return advance_by_tries(*this, setup_, steps, signals);
  const std::size_t width = signal_count(setup_.problem);
  if (rows_.is_staggered() && !is_started_) {
    to_host();
    rows_.start(evaluate(signals.first(width)).data());
    is_started_ = is_changed_ = true;
  }
  end_rates_.clear();
  rest_.clear(), edges_.clear();
  end_signals_.assign(signals.end() - std::ptrdiff_t(width), signals.end());
  to_device();
  problem_.set_signals(signals, width);
  forget_failures();
  return staged_ ? run_stages(steps) : run_passes(steps);
}

template <class T, int W>
void ResidentExecutor<T, W>::forget_failures() {
  const std::vector<cl_int> none(std::size_t(1 + 2 * bands_), INT_MAX);
  problem_.queue.write(failed_, 0, std::as_bytes(std::span(none)));
}

template <class T, int W>
void ResidentExecutor<T, W>::set_pass_arguments(long steps) {
  const std::vector<cl_int> none(std::size_t(bands_), 0);
  problem_.queue.write(progress_, 0, std::as_bytes(std::span(none)));
  cl_uint n = DeviceProblem<T, W>::table_arguments;
  for (const opencl::Buffer& table :
       {pass_table_, neighbour_table_, problem_.signals(), failed_, progress_})
    kernel_.set_one(n++, table);
  const int width = int(signal_count(setup_.problem)) + 1;
  for (const int value : {parity_, 0, shape_.steps, int(steps), sweeps_.count(), sweeps_.a_stage(),
                          width, 0, 0, 1}) // 0: set in run_to
    kernel_.set_one(n++, cl_int(value));
}

template <class T, int W>
Outcome ResidentExecutor<T, W>::run_passes(long steps) {
  const long passes = (steps + shape_.steps - 1) / shape_.steps;
  set_pass_arguments(steps);
  const int first_parity = parity_;
  const auto parity_after = [&](long pass) { return (first_parity + int(pass & 1)) & 1; };
  if (is_part()) {
    send(parity_);
    for (long pass = 0; pass < passes; ++pass) {
      const bool is_last = pass + 1 == passes;
      if (is_split_) {
        step_overlapped(pass, is_last);
        continue;
      }
      receive(parity_);
      parity_ = parity_after(pass + 1);
      run_to(pass + 1, false);
      if (!is_last) send(parity_);
    }
  } else {
    long done = 0;
    while (trials_left_ > 0 && done < passes_to_do(passes)) {
      run_to(passes, true);
      const long before = std::exchange(done, least_progress());
      if (done - before >= std::min(passes_to_do(passes) - before, 2L)) continue;
      --trials_left_; // bands were computed one after the other
      break;
    }
    for (long pass = done, last = passes_to_do(passes); pass < last; ++pass)
      run_to(pass + 1, false);
    parity_ = parity_after(passes);
  }
  return outcome(steps);
}

template <class T, int W>
void ResidentExecutor<T, W>::run_to(long last_pass, bool is_together) {
  // Looks at a counter, some 10 ms: what a sleeping thread may need to wake up.
  constexpr int patience = 1 << 24;
  kernel_.set_one(last_pass_argument, cl_int(last_pass));
  kernel_.set_one(patience_argument, cl_int(is_together ? patience : 0));
  launch_blocks(problem_.queue, 0, bands_);
}

template <class T, int W>
cl::Event ResidentExecutor<T, W>::launch_blocks(Queue& by, int first, int count,
                                                const Events& after, int stride) {
  kernel_.set_one(first_block_argument, cl_int(first));
  kernel_.set_one(block_stride_argument, cl_int(stride));
  return problem_.launch(by, kernel_, count, after);
}

// Edges and the rest of the rows read what the others published in the last step, and overwrite
// what the others read in the step before. So each waits for the others' last step. The rest of a
// step can then be computed while edges are computed and fetched, and while the next halo travels.
template <class T, int W>
void ResidentExecutor<T, W>::step_overlapped(long pass, bool is_last) {
  receive_all_sides(parity_);
  halo_rows_.bring(received_[std::size_t(parity_)]);
  parity_ ^= 1;
  kernel_.set_one(last_pass_argument, cl_int(pass + 1));
  const int edges = int(has_lower_edge_) + int(has_upper_edge_),
            first_edge = has_lower_edge_ ? 0 : bands_ - 1;
  const cl::Event edges_done =
      launch_blocks(halo_rows_.queue(), first_edge, edges, rest_, bands_ - 1);
  const cl::Event fetched = is_last ? cl::Event() : halo_rows_.fetch(sent_[std::size_t(parity_)]);
  const cl::Event rest_done =
      launch_blocks(problem_.queue, int(has_lower_edge_), bands_ - edges, edges_);
  halo_rows_.queue().flush();
  problem_.queue.flush();
  problem_.queue.await({edges_done, fetched});
  count_computing(); // of the last step: the edges have waited for its rest
  rest_ = {rest_done}, edges_ = {edges_done};
  if (!is_last) send_all_sides(parity_);
}

/// Adds the time of the last step in which edges, the rest, or both were computed.
template <class T, int W>
void ResidentExecutor<T, W>::count_computing() {
  if (edges_.empty()) return;
  guarded(problem_.queue.device().entry.name, [&] {
    const auto time = [](const cl::Event& event) {
      return std::pair(event.getProfilingInfo<CL_PROFILING_COMMAND_START>(),
                       event.getProfilingInfo<CL_PROFILING_COMMAND_END>());
    };
    rest_.front().wait();
    const auto [begin, end] = time(rest_.front());
    const auto [edges_begin, edges_end] = time(edges_.front());
    const cl_ulong from = std::max(begin, edges_begin), to = std::min(end, edges_end);
    computing_s_ +=
        1e-9 * double(end - begin + edges_end - edges_begin - (from < to ? to - from : 0));
  });
}

template <class T, int W>
long ResidentExecutor<T, W>::least_progress() {
  std::vector<cl_int> progress(std::size_t(bands_), 0);
  problem_.queue.read(progress_, 0, std::as_writable_bytes(std::span(progress)));
  return *std::min_element(progress.begin(), progress.end());
}

template <class T, int W>
long ResidentExecutor<T, W>::passes_to_do(long passes) {
  cl_int failed_step = INT_MAX;
  problem_.queue.read(failed_, 0, std::as_writable_bytes(std::span(&failed_step, 1)));
  return failed_step == INT_MAX ? passes : std::min(passes, long(failed_step / shape_.steps) + 1);
}

template <class T, int W>
Outcome ResidentExecutor<T, W>::outcome(long steps) {
  std::vector<cl_int> failed(std::size_t(1 + 2 * bands_));
  problem_.queue.read(failed_, 0, std::as_writable_bytes(std::span(failed)));
  count_computing();
  if (failed[0] == INT_MAX) return {true, steps, 0};
  if (staged_ && staged_->is_swapped() && (steps - 1 - failed[0]) % 2 != 0)
    staged_->swap(); // later steps were not done
  to_host();
  std::optional<std::size_t> first;
  for (int band = 0; band < bands_; ++band) {
    if (failed[std::size_t(1 + 2 * band)] != failed[0]) continue;
    const int r = failed[std::size_t(2 + 2 * band)];
    const auto element = packed_.first_failed(r, row(r), stored_fields());
    if (element && (!first || *element < *first)) first = element;
  }
  return {false, failed[0], first.value_or(0)};
}

// What other files call.
#define DSS_INSTANTIATE(T, W)                                                                      \
  template Outcome ResidentExecutor<T, W>::advance(long, std::span<const double>);                 \
  template Outcome ResidentExecutor<T, W>::outcome(long);                                          \
  template void ResidentExecutor<T, W>::forget_failures();                                         \
  template void ResidentExecutor<T, W>::set_pass_arguments(long);                                  \
  template void ResidentExecutor<T, W>::run_to(long, bool);
DSS_EACH_PACK(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE

} // namespace dss::opencl
