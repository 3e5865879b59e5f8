/// Stage by stage, or some stages in a launch: the tasks of the resident executor, its launches,
/// and tried steps.
#include "variants/api/tried_steps.hpp"
#include "variants/engine/packs.hpp"
#include "variants/opencl/resident_executor.hpp"

#include <algorithm>

namespace dss::opencl {

template <class T, int W>
StageTile ResidentExecutor<T, W>::tile_of_rows() const {
  const Method& method = setup_.method;
  if (!problem_.layout.has_items || is_part() || !setup_.problem.extra_links.empty() ||
      method.has_error_stage || method.stages == 1 || packed_.reach != 1 || sweeps_.has_pressure)
    return {};
  return choose_stage_tile(packed_.packs_across * W, int(packed_.rows.size()), method.stages,
                           sizeof(T) == 8 ? Precision::f64 : Precision::f32,
                           problem_.queue.device());
}

/// Makes the lists of row tasks: one for each band, or on a GPU for each row.
template <class T, int W>
void ResidentExecutor<T, W>::add_stages() {
  const int parities = staged_->is_swapped() ? 2 : 1;
  const bool has_items = problem_.layout.has_items;
  for (int parity = 0; parity < parities; ++parity) {
    for (int sweep = 0; sweep < sweeps_.count(); ++sweep) {
      std::vector<cl_int2>& lists = lists_.emplace_back();
      const int stage = sweeps_.stage(sweep);
      for (int band = 0; band < staged_->threads(); ++band) {
        const int begin = problem_.next_place();
        const bool is_pressure = sweeps_.is_pressure(sweep);
        const auto add = [&](int r, bool is_whole, const RowTask<T>& task) {
          if (has_items && !is_whole) return; // work-items compute links at both ends
          const row_action action = !is_whole     ? prime_of(prime_upper, is_pressure)
                                    : is_pressure ? find_pressure
                                                  : task.action;
          const int place = problem_.add(task, r, action, stored_fields());
          if (has_items) lists.push_back({{place, place + 1}});
        };
        if (is_pressure)
          staged_->each_pressure_task(band, stage, add);
        else
          staged_->each_task(band, stage, add);
        if (!has_items) lists.push_back({{begin, problem_.next_place()}});
      }
      bands_ = std::max(bands_, int(lists.size()));
    }
    if (parities == 2) staged_->swap();
  }
  // A part computes less of its halo in later stages.
  for (auto& lists : lists_) lists.resize(std::size_t(bands_));
}

template <class T, int W>
void ResidentExecutor<T, W>::launch_stage(int stage, long step) {
  const int parity = staged_->is_swapped() ? staged_->current_copy() : 0;
  if (problem_.has_extra_links())
    problem_.evaluate_extra_links(row_starts_[std::size_t(parity * setup_.method.stages + stage)]);
  const int last = sweeps_.of_stage(stage);
  for (int sweep = last + 1 - sweeps_.a_stage(); sweep <= last; ++sweep) {
    const auto table = std::size_t(parity * sweeps_.count() + sweep);
    set_stage_arguments(list_tables_[table], stage, step);
    problem_.launch_rows(kernel_, bands_);
  }
}

template <class T, int W>
void ResidentExecutor<T, W>::set_stage_arguments(const opencl::Buffer& lists, int stage,
                                                 long step) {
  const int stages = setup_.method.stages, width = int(signal_count(setup_.problem)) + 1;
  cl_uint n = DeviceProblem<T, W>::table_arguments;
  kernel_.set_one(n++, lists);
  kernel_.set_one(n++, problem_.signals());
  kernel_.set_one(n++, failed_);
  const int signal_row = int(step) * stages + stage;
  for (const cl_int value : {signal_row * width, int(step)}) kernel_.set_one(n++, value);
}

template <class T, int W>
void ResidentExecutor<T, W>::set_tile_arguments(int first_stage, int stages, long step) {
  const int of_method = setup_.method.stages, width = int(signal_count(setup_.problem)) + 1;
  const std::size_t list = std::size_t(staged_->current_copy() * of_method + first_stage);
  cl_uint n = DeviceProblem<T, W>::table_arguments;
  kernel_.set_one(n++, problem_.signals());
  kernel_.set_one(n++, failed_);
  for (const int value : {int(lists_[list].front().s[0]), int(packed_.rows.size()), stages,
                          (int(step) * of_method + first_stage) * width, width, int(step)})
    kernel_.set_one(n++, cl_int(value));
}

template <class T, int W>
void ResidentExecutor<T, W>::launch_tiles(long step) {
  const int stages = setup_.method.stages, of_launch = problem_.stage_tile().stages;
  for (int first = 0; first < stages; first += of_launch) {
    set_tile_arguments(first, std::min(of_launch, stages - first), step);
    problem_.launch_tiles(kernel_);
  }
  staged_->swap();
}

template <class T, int W>
Outcome ResidentExecutor<T, W>::run_stages(long steps) {
  if (is_part()) send(staged_->current_copy());
  for (long step = 0; step < steps; ++step) launch_step(step, step + 1 == steps);
  return outcome(steps);
}

template <class T, int W>
void ResidentExecutor<T, W>::launch_step(long step, bool is_last) {
  if (problem_.stage_tile().is_used()) return launch_tiles(step);
  const int stages = setup_.method.stages;
  const auto exchanged = [&](int stage) { return is_part() && staged_->is_exchanged(stage); };
  for (int stage = 0; stage < stages; ++stage) {
    if (exchanged(stage)) receive(staged_->copy_of(stage));
    launch_stage(stage, step);
    const bool is_step_done = stage + 1 == stages;
    if (is_step_done && staged_->is_swapped()) staged_->swap();
    const int next = is_step_done ? 0 : stage + 1;
    if (exchanged(next) && !(is_step_done && is_last)) send(staged_->copy_of(next));
  }
}

constexpr std::size_t maxima_of_band = 2 * StepMaxima::kinds + 1;

template <class T, int W>
void ResidentExecutor<T, W>::make_error_kernels() {
  // warm_up_error_kernels sets this argument.
  constexpr cl_uint lists = DeviceProblem<T, W>::table_arguments;
  maxima_ = problem_.queue.make_buffer(std::size_t(bands_) * maxima_of_band * sizeof(T));
  maxima_kernel_ = problem_.kernel("step_maxima");
  maxima_kernel_.set_one(lists + 1, maxima_);
  maxima_kernel_.set_one(lists + 2, cl::Local(problem_.group_size() * maxima_of_band * sizeof(T)));
  accept_kernel_ = problem_.kernel("accept_rows");
}

template <class T, int W>
void ResidentExecutor<T, W>::warm_up_error_kernels(const opencl::Buffer& nothing) {
  constexpr cl_uint lists = DeviceProblem<T, W>::table_arguments;
  for (Kernel* const kernel : {&maxima_kernel_, &accept_kernel_}) {
    kernel->set_one(lists, nothing);
    problem_.launch(problem_.queue, *kernel, bands_);
    kernel->set_one(lists, list_tables_.back()); // of the last stage
  }
}

template <class T, int W>
StepMaxima ResidentExecutor<T, W>::try_step(double dt, std::span<const double> signals) {
  to_device();
  problem_.set_signals(signals, signal_count(setup_.problem));
  kernel_.set_one(DeviceProblem<T, W>::step_argument, T(dt));
  if (is_part()) send(staged_->current_copy());
  launch_step(0, true);
  problem_.launch(problem_.queue, maxima_kernel_, bands_);
  std::vector<T> bands(std::size_t(bands_) * maxima_of_band);
  problem_.queue.read(maxima_, 0, std::as_writable_bytes(std::span(bands)));
  StepMaxima all;
  for (std::size_t band = 0; band < bands.size(); band += maxima_of_band) {
    StepMaxima one;
    std::copy_n(&bands[band], StepMaxima::kinds, one.error.begin());
    std::copy_n(&bands[band + StepMaxima::kinds], StepMaxima::kinds, one.state.begin());
    one.is_finite = bands[band + 2 * StepMaxima::kinds] == 0;
    all.add(one);
  }
  return all;
}

template <class T, int W>
void ResidentExecutor<T, W>::accept_step() {
  to_device();
  problem_.launch_rows(accept_kernel_, bands_);
}

// What other files call.
#define DSS_INSTANTIATE(T, W)                                                                      \
  template StageTile ResidentExecutor<T, W>::tile_of_rows() const;                                 \
  template void ResidentExecutor<T, W>::add_stages();                                              \
  template Outcome ResidentExecutor<T, W>::run_stages(long);                                       \
  template StepMaxima ResidentExecutor<T, W>::try_step(double, std::span<const double>);           \
  template void ResidentExecutor<T, W>::accept_step();                                             \
  template void ResidentExecutor<T, W>::make_error_kernels();                                      \
  template void ResidentExecutor<T, W>::warm_up_error_kernels(const opencl::Buffer&);              \
  template void ResidentExecutor<T, W>::set_stage_arguments(const opencl::Buffer&, int, long);     \
  template void ResidentExecutor<T, W>::set_tile_arguments(int, int, long);
DSS_EACH_PACK(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE

} // namespace dss::opencl
