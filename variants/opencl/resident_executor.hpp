#pragma once
/// The executor of the variant `opencl`. The state stays on the device, which computes whole steps.
/// Schedules, blocks of rows and their memory come from the engine.
#include "solver/numerics/signal_rows.hpp"
#include "variants/api/api.hpp"
#include "variants/engine/blocks.hpp"
#include "variants/engine/state_rows.hpp"
#include "variants/engine/wavefront.hpp"
#include "variants/opencl/device_rates.hpp"
#include "variants/opencl/halo_rows.hpp"

#include <optional>

namespace dss::opencl {

/// Computes a problem, or a part of one, on a device, with packs of W lanes of T. The schedule is a
/// wavefront over bands of rows (blocks_) or stage by stage (staged_). A band is a block of rows
/// that one work-group computes.
template <class T, int W>
class ResidentExecutor final : public Executor,
                               public StepTrials,
                               public PartHalos,
                               public StateTransfer,
                               public DeviceWork {
public:
  ResidentExecutor(const Setup& setup, const Device& device, const Layout& layout);
  void write(std::size_t first, std::span<const double> fields) override;
  void read(std::size_t first, std::span<double> fields) override;
  void derivative(std::span<const double> signals, std::span<double> rates) override;
  bool repeat_derivative(long times, std::span<double> rates) override;
  Outcome advance(long steps, std::span<const double> signals) override;
  StepTrials* step_trials() override { return this; }
  PartHalos* part_halos() override { return this; }
  StateTransfer* state_transfer() override { return this; }
  DeviceWork* device_work() override { return this; }
  StepMaxima try_step(double dt, std::span<const double> signals) override;
  void accept_step() override;
  std::string schedule() const override;
  int workers() const override { return bands_; }
  std::size_t bytes() const override { return problem_.bytes(); }
  int halo_copies() const override { return staged_ ? staged_->copies() : 2; }
  int halo_lanes() const override { return W; }
  HaloLayout halo_layout(std::span<const std::size_t> elements, int copy) override;
  int kept_fields() const override { return rows_.kept_fields(); }
  void save(std::size_t first, std::span<double> kept) override;
  void restore(std::size_t first, std::span<const double> kept) override;
  DeviceUse device_use() const override;
  double computing_s() const override { return is_split_ ? computing_s_ : -1; }

private:
  /// Indices of those arguments of run_passes that change between launches (device/passes.cl).
  static constexpr cl_uint last_pass_argument = DeviceProblem<T, W>::table_arguments + 6,
                           patience_argument = last_pass_argument + 6,
                           first_block_argument = patience_argument + 1,
                           block_stride_argument = first_block_argument + 1;
  using Range = typename DeviceProblem<T, W>::Range;
  bool is_part() const { return part_ != nullptr; }
  int stored_fields() const { return rows_.stored_fields(); }
  void make_blocks();
  void add_neighbours(const std::vector<int>& cuts, int band, int halo);
  /// The tile of a method of several stages whose rows need only the rows next to them.
  StageTile tile_of_rows() const;
  void add_stages();
  void make_kernels();
  void set_pass_arguments(long steps);
  /// @param stages  to compute from `first_stage` on
  void set_tile_arguments(int first_stage, int stages, long step);
  void set_stage_arguments(const opencl::Buffer& lists, int stage, long step);
  /// Launches all kernels with nothing to do: some drivers, such as PoCL, compile a kernel at its
  /// first launch.
  void warm_up();
  T* row(int r);
  std::pair<T*, T*> copy_row(int copy, int r);
  std::size_t row_size(int r) const {
    return std::size_t(packed_.rows[std::size_t(r)].packs) * std::size_t(stored_fields() * W);
  }
  void publish_changed();
  std::vector<Range> state_ranges();
  void make_images(std::span<const std::size_t> elements, int copy);
  void add_to_halo(int r, std::span<const std::size_t> elements, int copy, HaloLayout& layout);
  /// Gives the arena to the host, with the state and its halo, until to_device().
  void to_host();
  void to_device();
  /// Parts: sends or receives on all sides, and moves the halo between device and host.
  void send(int copy);
  void receive(int copy);
  void send_all_sides(int copy);
  void receive_all_sides(int copy);
  std::vector<T> evaluate(std::span<const double> signals);
  void stop_leapfrog();
  Outcome run_passes(long steps);
  /// Computes all bands up to the end of a pass.
  /// @param is_together  one launch for all passes; needs bands that are computed at the same time
  void run_to(long last_pass, bool is_together);
  /// Launches every stride-th block, counted without remote ones.
  cl::Event launch_blocks(Queue& by, int first, int count, const Events& after = {},
                          int stride = 1);
  /// One step of a part that is split. One queue has the halo, the edges and what is sent of them;
  /// the other queue has all other rows.
  void step_overlapped(long pass, bool is_last);
  void count_computing();
  /// The first row of each block, then the end. Edges that neighbours wait for are blocks of their
  /// own in a part that is split; sets is_split_.
  std::vector<int> cut_blocks();
  long least_progress();
  /// Passes to do: all up to the one that failed, at most `passes`.
  long passes_to_do(long passes);
  Outcome run_stages(long steps);
  /// Launches all stages of a step and exchanges their halos. `is_last`: the halo of its result is
  /// not sent.
  void launch_step(long step, bool is_last);
  void make_error_kernels();
  void warm_up_error_kernels(const opencl::Buffer& nothing);
  void launch_stage(int stage, long step);
  /// Launches all stages of a step of a whole problem, some in each launch.
  void launch_tiles(long step);
  void forget_failures();
  Outcome outcome(long steps);

  const Setup setup_;
  const PartSetup* part_; ///< null for a whole problem and for a part without neighbours
  const StepSweeps sweeps_{setup_.method, setup_.problem};
  DeviceProblem<T, W> problem_;
  PackedRows<T, W>& packed_ = problem_.packed;
  StateRows<T, W> rows_;
  Blocks<T, W> blocks_;                    ///< of the wavefront
  std::optional<StagedRows<T, W>> staged_; ///< stage by stage, in place of blocks_
  int bands_ = 1;
  PassShape shape_;
  RowDivision division_; ///< of the wavefront
  /// Parts: the edges that neighbours wait for are blocks of their own, first and last.
  bool is_split_ = false;
  bool has_lower_edge_ = false, has_upper_edge_ = false;
  Events rest_, edges_; ///< if split: launches of the last step
  /// Compute time of a split part [s].
  double computing_s_ = 0;
  int parity_ = 0;
  /// is_changed_: the host has changed the state since the device had it; it is published when it
  /// goes to the device.
  bool is_on_host_ = false, is_changed_ = false;
  /// How often advance() may still try bands that wait for one another. A try fails if the bands
  /// are not computed at the same time.
  int trials_left_ = 0;
  /// [parity * sweeps of a step + sweep]: list of each band
  std::vector<std::vector<cl_int2>> lists_;
  std::vector<cl_int2> passes_;     ///< of each block, [parity]: its tasks
  std::vector<cl_int2> neighbours_; ///< of each band: the bands whose rows it reads
  opencl::Buffer pass_table_, neighbour_table_, failed_, progress_;
  std::vector<opencl::Buffer> list_tables_, row_starts_;
  Kernel kernel_;
  Kernel maxima_kernel_, accept_kernel_; ///< of methods with an error stage
  opencl::Buffer maxima_; ///< the same; numbers of each band as in device/step_error.cl
  /// Mutable like the problem's queue, since counting waits for transfers.
  mutable HaloRows<T, W> halo_rows_;
  std::vector<typename HaloRows<T, W>::Ranges> sent_, received_; ///< of each copy
  bool is_started_ = false; ///< leapfrog: the stored velocities are those of the last half step
  std::vector<double> end_signals_;
  /// Leapfrog: rates at the end of the last advance, computed when first read.
  std::vector<T> end_rates_;
  std::unique_ptr<DeviceRates<T, W>> rates_;
};

} // namespace dss::opencl
