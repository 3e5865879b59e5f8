#pragma once
/// The whole interface between the program and an execution target. A variant is one MODULE library that exports
/// dss_plugin().
#include "kernels/compiled_kernel.hpp"
#include "solver/model/model.hpp"
#include "solver/model/problem.hpp"
#include "solver/model/rotation.hpp"
#include "solver/numerics/method.hpp"
#include "solver/numerics/step_control.hpp"
#include "variants/device.hpp"
#include "variants/distribution.hpp"
#include "variants/halo.hpp"
#include "variants/member.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace dss {

/// What to compute and how. `problem` and `method` outlive the executor.
/// In place of a device: none is to be used.
inline constexpr const char* no_device = "none";

struct Setup {
  const Problem& problem;
  const Method& method;
  Model model = Model::spatial;
  Precision precision = Precision::f64;
  double dt = 0; ///< of a method with an error stage that of advance alone
  int threads = 1;
  const PartSetup* part = nullptr;            ///< `problem` is a part of a larger one; outlives the executor
  const Distribution* distribution = nullptr; ///< for distributed variants, which take the default without
  std::string device{};                       ///< of a variant on devices: see DeviceEntry; empty: its first; of a
                                              ///< hybrid without `members`: no_device, or empty
  std::string members{};                      ///< of a hybrid: see parse_members; empty: its own choice, not questioned
  Rotation rotation = Rotation::quaternion;   ///< others than quaternions: of plug-ins that say has_all
};

/// Result of advance(): finite, or where the state first was not, or a step's equations were not solved.
struct Outcome {
  bool is_finite = true;
  long step = 0;           ///< steps completed in this call; the failing step (counted from 0) when not finite
  std::size_t element = 0; ///< first element that is not finite
  std::string_view what = "the state is not finite"; ///< or why else the step failed; static text
};

/// One scene on one target. On several ranks each of them makes one, calls are collective, and all ranks get the same results. Fields are as in solver/model/fields.hpp, whatever the model and the precision inside.
class Executor {
public:
  virtual ~Executor() = default;
  /// Sets or gets the fields of elements [first, first + fields.size() / 13); a write restarts the method.
  virtual void write(std::size_t first, std::span<const double> fields) = 0;
  virtual void read(std::size_t first, std::span<double> fields) = 0;
  /// Time derivative of all fields of all elements at the present state. `signals`: one row, see
  /// solver/numerics/signal_rows.hpp.
  virtual void derivative(std::span<const double> signals, std::span<double> rates) = 0;
  /// What a device's kernel of all rates takes by itself: what derivative() was asked for just before, as many times again, without
  /// transfers; then the rates are read unless `rates` is empty. Of `opencl`. @return whether it did
  virtual bool repeat_derivative(long times, std::span<double> rates) { return (void)times, (void)rates, false; }
  /// Advances by `steps` steps; stops at the first step that leaves a non-finite state.
  /// `signals`: steps * method.stages + 1 rows, see solver/numerics/signal_rows.hpp.
  virtual Outcome advance(long steps, std::span<const double> signals) = 0;
  /// Of a method with an error stage: tries a step of dt [s] from the present state, which stays as it is. `signals`: method.stages rows, see
  /// stage_signals. @return maxima over all elements, which depend on no order
  virtual StepMaxima try_step(double /*dt*/, std::span<const double> /*signals*/) {
    throw std::logic_error("this executor has no adaptive steps");
  }
  /// Makes the result of the step tried last, which is finite, the state.
  virtual void accept_step() {}
  /// One line for the record: "wavefront, reach 1" or "stage by stage: extra links".
  virtual std::string schedule() const = 0;
  /// Threads that compute: what Setup asks for, or fewer where the problem has fewer rows.
  virtual int workers() const = 0;
  /// Bytes held for state, halos, rings and masks.
  virtual std::size_t bytes() const = 0;
  /// Copies of the elements that an executor of a part exchanges; 0: it cannot compute parts.
  virtual int halo_copies() const { return 0; }
  /// Elements that lie together in a copy: only layouts of executors with equal numbers have messages in the same order (message_order.hpp).
  virtual int halo_lanes() const { return 0; }
  /// Where everything stored of these elements (ascending, local numbers) lies in a copy; asked for before the first exchange. Own elements are there to be read: every
  /// offset is given once. Halo elements are there to be written, some offsets in several places.
  virtual HaloLayout halo_layout(std::span<const std::size_t> elements, int copy) {
    return (void)elements, (void)copy, HaloLayout{};
  }
  virtual RankInfo rank_info() const { return {}; }
  virtual Traffic traffic() const { return {}; }
  /// What a method keeps of an element: 13 fields, and with some methods more (variants/kept_state.hpp).
  virtual int kept_fields() const { return 0; }
  /// Gets or sets all that the method keeps of elements [first, first + kept.size() / kept_fields()), so that another executor of the same
  /// method, model and precision goes on to the last bit, whichever elements it has. After restore comes write or advance. 0
  /// kept_fields: it cannot.
  virtual void save(std::size_t first, std::span<double> kept) { (void)first, (void)kept; }
  virtual void restore(std::size_t first, std::span<const double> kept) { (void)first, (void)kept; }
  /// Time in which it computed, in all calls of advance, where it knows better than who waits for it: with halos that come and go behind the
  /// computation. Negative: it does not [s].
  virtual double computing_s() const { return -1; }
  /// What was used of a device, and what its use cost.
  virtual DeviceUse device_use() const { return {}; }
  /// What the members of a hybrid do.
  virtual HybridInfo hybrid_info() const { return {}; }
  /// This rank now works while others wait, perhaps for long, or no longer does. Not collective.
  virtual void work_alone(bool is_alone) { (void)is_alone; }
  /// This value of every rank, in their order. Collective.
  virtual std::vector<double> gather(double value) { return {value}; }
};

/// Of what both sides pass to each other: a module compiled with other headers, or another standard library, differs.
constexpr std::size_t plugin_layout = [] {
  std::size_t layout = 0;
  for (const std::size_t size :
       {sizeof(Setup), sizeof(Problem), sizeof(Body), sizeof(Lattice), sizeof(Row), sizeof(Method), sizeof(Outcome),
        sizeof(StepMaxima), sizeof(PartSetup), sizeof(Part), sizeof(Distribution), sizeof(HaloLayout), sizeof(RankInfo),
        sizeof(Traffic), sizeof(DeviceUse), sizeof(HybridInfo), sizeof(CompiledKernel)})
    layout = layout * 1009 + size;
  return layout;
}();

struct Plugin {
  int abi;
  const char* name;
  const char* isa; ///< of the code that runs, reported by that code: "avx512", "avx2", "x86-64-v2", ...
  bool has_fma;    ///< results are bitwise equal to every other variant that says so
  bool is_threaded;
  bool is_distributed; ///< computes on all ranks of the job
  std::unique_ptr<Executor> (*create)(const Setup& setup);
  std::span<const CompiledKernel> (*kernels)();           ///< null if the variant has no kernels of its own
  void (*end)(int exit_code, bool is_in_order) = nullptr; ///< null, or see end_variants
  std::string (*why_unusable)() = nullptr; ///< null, or empty if it can run here, else why not: "no OpenCL platform"
  std::vector<DeviceEntry> (*devices)() = nullptr; ///< null, or the devices that it can use, and those that it cannot
  DeviceCeilings (*ceilings)(const std::string& device) = nullptr; ///< null, or measures a device named as for --device
  bool is_compensated = true;                                      ///< has Precision::f32c
  bool has_all = false; ///< implicit methods and every Rotation too; others have the explicit methods, and quaternions
  std::size_t layout = plugin_layout;
};

constexpr int plugin_abi =
    10; ///< to be raised with every change of Plugin, Executor or what they are handed (Method, Problem, Model)
using PluginEntry = const Plugin* (*)();
constexpr const char* plugin_symbol = "dss_plugin";

} // namespace dss
