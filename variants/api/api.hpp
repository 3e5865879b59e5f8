#pragma once
/// The interface between the program and an execution target. A variant is one MODULE library that
/// exports dss_plugin(), which returns a Plugin. Plugin::create makes an Executor (executor.hpp),
/// which holds the state of one scene and advances it in time. Some executors can do more
/// (capabilities.hpp). variants/reference/plugin.cpp is a complete example with adaptive steps.
#include "kernels/compiled_kernel.hpp"
#include "kernels/model.hpp"
#include "solver/model/ensemble.hpp"
#include "solver/model/problem.hpp"
#include "solver/model/rotation.hpp"
#include "solver/numerics/method.hpp"
#include "variants/api/capabilities.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace dss {

/// Value of Setup::device that forbids devices.
inline constexpr const char* no_device = "none";

/// What to compute and how. `problem`, `method`, `part` and `distribution` outlive the executor.
struct Setup {
  const Problem& problem;
  const Method& method;
  Model model = Model::spatial;
  Precision precision = Precision::f64;
  /// Step [s]. A method with an error stage uses it in advance() only.
  double dt = 0;
  int threads = 1;
  /// Not null: `problem` is a part of a larger one.
  const PartSetup* part = nullptr;
  /// Of distributed variants; null: the default Distribution.
  const Distribution* distribution = nullptr;
  /// Variants on devices: text of --device (choose_device in device.hpp). Empty: the first device.
  /// A hybrid without `members` takes no_device or an empty text.
  std::string device{};
  /// Hybrids: text for parse_members. Empty: the hybrid takes two members without trials.
  std::string members{};
  /// Others than quaternions need a plug-in with has_all.
  Rotation rotation = Rotation::quaternion;
  /// Width of a tile of the wavefront: rows across, in plates elements along x (rounded to packs,
  /// at least one for each sweep). 0: as suits the caches. Others than 0 need a plug-in with
  /// has_tiles.
  int tile = 0;
  /// Not null: the executor computes all members (Plugin::ensemble_lanes of them), of which
  /// `problem` is the first. Elements are then those of the ensemble, and a row of signals has each
  /// signal of all members side by side.
  const Ensemble* ensemble = nullptr;

  /// The step of each member [s]; of a problem alone: its own.
  std::span<const double> steps() const {
    return ensemble == nullptr ? std::span(&dt, 1) : std::span<const double>(ensemble->dt);
  }
};

/// Checksum of the sizes of all types that program and module exchange. It differs if the module
/// was compiled with other headers or with another standard library.
constexpr std::size_t plugin_layout = [] {
  std::size_t layout = 0;
  for (const std::size_t size :
       {sizeof(Setup), sizeof(Ensemble), sizeof(Problem), sizeof(Body), sizeof(Lattice),
        sizeof(Row), sizeof(Method), sizeof(Outcome), sizeof(StepMaxima), sizeof(PartSetup),
        sizeof(Part), sizeof(Distribution), sizeof(HaloLayout), sizeof(RankInfo), sizeof(Traffic),
        sizeof(DeviceUse), sizeof(HybridInfo), sizeof(FactorInfo), sizeof(CompiledKernel)})
    layout = layout * 1009 + size;
  return layout;
}();

/// What a module tells the program about itself. Functions with a default, and `kernels`, may be
/// null.
struct Plugin {
  int abi;
  const char* name;
  /// Instruction set, reported by the code that runs: "avx512", "avx2", "x86-64-v2", ...
  const char* isa;
  bool has_fma; ///< results have the same bits as those of every other variant with has_fma
  bool is_threaded;
  bool is_distributed; ///< computes on all ranks of the job
  std::unique_ptr<Executor> (*create)(const Setup& setup);
  std::span<const CompiledKernel> (*kernels)(); ///< null if the variant has no kernels of its own
  void (*end)(int exit_code, bool is_in_order) = nullptr; ///< see end_variants
  /// Returns an empty text if the variant can run here, else the reason: "no OpenCL platform".
  std::string (*why_unusable)() = nullptr;
  /// All devices, usable or not.
  std::vector<DeviceEntry> (*devices)() = nullptr;
  /// Measures a device, which is named as for --device.
  DeviceCeilings (*ceilings)(const std::string& device) = nullptr;
  bool is_compensated = true; ///< has Precision::f32c
  /// Has all methods and every Rotation. Other variants have quaternions, and the explicit methods
  /// or, with is_implicit, the implicit ones.
  bool has_all = false;
  bool is_implicit = false;        ///< has the implicit methods and f64 alone
  bool has_pressure = false;       ///< computes elements with a pressure (Problem::has_pressure)
  bool has_rotating_frame = false; ///< computes in one (Problem::has_rotating_frame)
  bool has_mass_ratios = false;    ///< elements may differ in mass (Problem::has_mass_ratios)
  bool has_tiles = false;          ///< takes Setup::tile
  /// Members of an ensemble that one executor computes: a member a lane of each rank. Null: none.
  /// @param distribution  for distributed variants
  int (*ensemble_lanes)(Precision precision, const Distribution& distribution) = nullptr;
  /// Rotation of a run that asks for none.
  Rotation rotation = Rotation::quaternion;
  std::size_t layout = plugin_layout;

  /// Has implicit methods. Then it computes whole problems alone, and does not give out what its
  /// methods keep.
  bool solves_equations() const { return has_all || is_implicit; }
};

/// Raise this with every change of Plugin, Executor or a type that they receive (Method, Problem,
/// Model).
constexpr int plugin_abi = 21;
using PluginEntry = const Plugin* (*)();
constexpr const char* plugin_symbol = "dss_plugin";

} // namespace dss
