#include "experiments/measure/kernels/micro_case.hpp"
#include "experiments/measure/kernels/kernel_error.hpp"
#include "experiments/measure/kernels/kernel_work.hpp"
#include "experiments/run/state/state_access.hpp"
#include "kernels/fields.hpp"
#include "kernels/model.hpp"
#include "solver/error.hpp"
#include "solver/model/sufficiency/sufficiency.hpp"
#include "solver/nearest_name.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "solver/scene/scene.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <set>

namespace dss {
namespace {

constexpr const char *step_kernel = "rk4_step", *rates_kernel = "rates";

std::size_t precision_bytes(Precision precision) { return precision == Precision::f64 ? 8 : 4; }

/// State of a plate in which every element moves slightly: arithmetic on zeros takes less power and
/// time.
std::vector<double> moving_state(std::size_t elements) {
  constexpr double size = 1e-6; // [m], [m/s], [rad/s]: much smaller than the edge of an element
  std::vector<double> fields(elements * field_count);
  for (std::size_t k = 0; k < fields.size(); ++k)
    fields[k] = size * std::sin(0.7 * double(k % 997) + 0.1);
  for (std::size_t e = 0; e < elements; ++e) {
    double* q = &fields[e * field_count + qs];
    q[0] = -(q[1] * q[1] + q[2] * q[2] + q[3] * q[3]) / 2; // a unit quaternion
  }
  return fields;
}

/// RK4 steps of a plate; a pass is `steps_a_call` steps.
class PlateSteps : public MicroWork {
public:
  PlateSteps(const Plugin& plugin, Model model, Precision precision, int n, int threads)
      : scene_(load_scene("plate_paper", {{"n", std::to_string(n)}})), method_(*find_method("rk4")),
        executor_(
            plugin.create({scene_.problem, method_, model, precision, scene_.problem.dt, threads})),
        signals_(signal_rows(scene_.problem, method_, scene_.problem.dt, 0, steps_a_call)) {
    executor_->write(0, moving_state(scene_.problem.lattice.element_count));
  }
  void pass() override {
    if (!executor_->advance(steps_a_call, signals_).is_finite)
      throw std::logic_error("micro_case.cpp: plate_paper became unstable");
  }
  static constexpr long steps_a_call = 10;

private:
  const Scene scene_;
  const Method& method_;
  std::unique_ptr<Executor> executor_;
  std::vector<double> signals_;
};

/// Fields after a few steps from rest, in global order of elements.
std::vector<double> fields_after(const Plugin& plugin, Model model, Precision precision,
                                 const Scene& scene, long steps, int threads) {
  const Method& method = *find_method("rk4");
  const auto executor =
      plugin.create({scene.problem, method, model, precision, scene.problem.dt, threads});
  executor->advance(steps, signal_rows(scene.problem, method, scene.problem.dt, 0, steps));
  std::vector<double> fields(scene.problem.lattice.element_count * field_count);
  executor->read(0, fields);
  return fields;
}

/// Largest difference of displacements from those of the reference variant after two steps,
/// relative to the largest displacement.
double step_error(const Plugin& plugin, Model model, Precision precision, int n, int threads) {
  constexpr long steps = 2;
  const Scene scene = load_scene("plate_paper", {{"n", std::to_string(n)}});
  static std::map<int, std::vector<double>> right; // by n; shared by all variants
  auto& expected = right[n];
  if (expected.empty())
    expected =
        fields_after(load_variant("reference"), Model::spatial, Precision::f64, scene, steps, 1);
  const std::vector<double> fields = fields_after(plugin, model, precision, scene, steps, threads);
  return displacement_difference(fields, expected);
}

/// Sets the fields that the model lacks to zero.
std::vector<double> restricted(std::vector<double> fields, Model model) {
  const std::span<const Field> kept = descriptor(model).fields;
  for (std::size_t n = 0; n < fields.size(); ++n)
    if (std::ranges::find(kept, Field(n % field_count)) == kept.end()) fields[n] = 0;
  return fields;
}

/// A plate in motion, as input for computing rates.
struct MovingPlate {
  Scene scene;
  std::vector<double> state, signals;
  MovingPlate(Model model, int n) : scene(load_scene("plate_paper", {{"n", std::to_string(n)}})) {
    state = restricted(moving_state(scene.problem.lattice.element_count), model);
    signals = signal_rows(scene.problem, *find_method("rk4"), scene.problem.dt, 0, 1);
    signals.resize(signal_count(scene.problem));
  }
  std::unique_ptr<Executor> executor(const Plugin& plugin, Model model, Precision precision,
                                     int threads) const {
    auto made = plugin.create(
        {scene.problem, *find_method("rk4"), model, precision, scene.problem.dt, threads});
    made->write(0, state);
    return made;
  }
};

/// A device's kernel that computes all rates of a plate; a pass is ten launches.
class DeviceRates : public MicroWork {
public:
  DeviceRates(const Plugin& plugin, Model model, Precision precision, int n, int threads)
      : plate_(model, n), executor_(plate_.executor(plugin, model, precision, threads)) {
    std::vector<double> rates(plate_.state.size());
    executor_->derivative(plate_.signals, rates);
  }
  void pass() override { repeat(launches_a_pass, {}); }
  /// Launches the kernel `times` times. `rates` receives the result of the last launch.
  void repeat(long times, std::span<double> rates) {
    if (!repeat_derivative(*executor_, times, rates))
      throw InputError("rates: the variant has no kernel on a device that computes them by itself");
  }
  const MovingPlate& plate() const { return plate_; }
  static constexpr long launches_a_pass = 10;

private:
  const MovingPlate plate_;
  std::unique_ptr<Executor> executor_;
};

/// Error of the timed rates against those of the reference variant, by state_error.
double rates_error(const Plugin& plugin, Model model, Precision precision, int n, int threads) {
  DeviceRates work(plugin, model, precision, n, threads);
  const MovingPlate& plate = work.plate();
  std::vector<double> right(plate.state.size()), rates(right.size());
  plate.executor(load_variant("reference"), model, Precision::f64, 1)
      ->derivative(plate.signals, right);
  work.repeat(2, rates);
  return state_error(plate.scene.problem, restricted(right, model), restricted(rates, model));
}

bool has_name(const std::vector<std::string>& names, std::string_view name) {
  return std::ranges::any_of(names,
                             [&](const std::string& one) { return one == "*" || one == name; });
}

void require_known(const std::vector<std::string>& names, const std::string& what,
                   std::vector<std::string> known) {
  for (const std::string& name : names)
    if (name != "*" && std::ranges::find(known, name) == known.end())
      throw InputError(
          fmt::format("{} \"{}\" does not exist; {}", what, name, nearest_name(name, known)));
}

std::vector<std::string> kernel_names(const std::vector<const Plugin*>& plugins) {
  std::set<std::string> names{step_kernel, rates_kernel};
  for (const Plugin* plugin : plugins)
    if (plugin->kernels != nullptr)
      for (const CompiledKernel& kernel : plugin->kernels()) names.insert(kernel.name);
  return {names.begin(), names.end()};
}

void require_known_names(const MicroSet& set, const std::vector<const Plugin*>& plugins) {
  std::vector<std::string> variant_list;
  for (const VariantStatus& variant : variants()) variant_list.push_back(variant.name);
  require_known(set.kernels, "kernel", kernel_names(plugins));
  require_known(set.models, "model", model_names());
  require_known(set.precisions, "precision", {"f64", "f32"});
  require_known(set.variants, "variant", variant_list);
  require_known(set.levels, "level", memory_levels);
}

void add_kernels(const MicroSet& set, const Plugin& plugin, std::vector<MicroCase>& cases) {
  if (plugin.kernels == nullptr) return;
  for (const CompiledKernel& kernel : plugin.kernels())
    if (has_name(set.kernels, kernel.name) && has_name(set.models, name(kernel.model)) &&
        has_name(set.precisions, name(kernel.precision)))
      for (const std::string& level : memory_levels)
        for (const int threads : set.threads)
          if (has_name(set.levels, level))
            cases.push_back(kernel_case(plugin, kernel, level, threads));
}

/// Adds cases of plates. `make_case` is step_case or rates_case.
template <class MakeCase>
void add_plates(const MicroSet& set, const Plugin& plugin, MakeCase&& make_case,
                std::vector<MicroCase>& cases) {
  for (const Model model : models)
    for (const Precision precision : {Precision::f64, Precision::f32})
      for (const int n : set.sizes)
        for (const int threads : set.threads)
          if (has_name(set.models, name(model)) && has_name(set.precisions, name(precision)))
            cases.push_back(make_case(plugin, model, precision, n, threads));
}

void add_steps(const MicroSet& set, const Plugin& plugin, std::vector<MicroCase>& cases) {
  if (has_name(set.kernels, step_kernel) && !plugin.is_distributed)
    add_plates(set, plugin, step_case, cases);
  if (has_name(set.kernels, rates_kernel) && plugin.devices != nullptr && !plugin.is_distributed)
    add_plates(set, plugin, rates_case, cases);
}

} // namespace

std::string MicroCase::cell() const {
  return fmt::format("{}{}/{}/{}/{}/{}/{}", kernel, n > 0 ? fmt::format("_{}", n) : "", name(model),
                     name(precision), variant, level, threads);
}

MicroCase kernel_case(const Plugin& plugin, const CompiledKernel& kernel, const std::string& level,
                      int threads) {
  const WorkingSet wanted = working_set(level, threads);
  const KernelShape shape = kernel_shape(kernel, wanted.bytes);
  const std::size_t numbers = std::size_t(kernel.inputs + kernel.outputs);
  MicroCase one;
  one.kernel = kernel.name, one.model = kernel.model, one.precision = kernel.precision;
  one.variant = plugin.name, one.isa = plugin.isa, one.level = level, one.threads = threads;
  one.flops = kernel.flops, one.bytes = double(numbers * precision_bytes(kernel.precision));
  one.working_set_bytes = shape.elements * std::size_t(one.bytes);
  one.elements = double(shape.elements) * threads;
  one.skipped = wanted.unusable;
  one.make = [&kernel, shape] { return std::make_unique<KernelWork>(kernel, shape); };
  one.error = [&kernel] { return kernel_error(kernel); };
  return one;
}

/// The common part of step_case and rates_case.
static MicroCase plate_case(const Plugin& plugin, Model model, Precision precision, int n,
                            int threads) {
  MicroCase one;
  one.model = model, one.precision = precision, one.n = n;
  one.variant = plugin.name, one.isa = plugin.isa, one.threads = threads;
  one.bytes = 2 * double(descriptor(model).fields.size() * precision_bytes(precision));
  one.is_threaded_inside = true;
  if (model == Model::axial) one.skipped = "a plate is no bar";
  return one;
}

/// Reason why the model cannot step the paper's plate, whose load lies in its plane; empty if it
/// can. The answer does not depend on the number of elements.
static std::string why_no_steps(Model model) {
  static const Scene scene = load_scene("plate_paper", {{"n", "4"}});
  return why_not(model, scene.problem);
}

MicroCase step_case(const Plugin& plugin, Model model, Precision precision, int n, int threads) {
  MicroCase one = plate_case(plugin, model, precision, n, threads);
  one.kernel = step_kernel;
  if (one.skipped.empty()) one.skipped = why_no_steps(model);
  one.flops = descriptor(model).flops.rk4_step();
  one.working_set_bytes =
      std::size_t(n) * std::size_t(n) * std::size_t(one.bytes) / 2 / std::size_t(threads);
  one.level = level_of(one.working_set_bytes);
  one.elements = double(n) * n * double(PlateSteps::steps_a_call);
  one.make = [&plugin, model, precision, n, threads] {
    return std::make_unique<PlateSteps>(plugin, model, precision, n, threads);
  };
  if (one.variant != "reference")
    one.error = [&plugin, model, precision, n, threads] {
      return step_error(plugin, model, precision, n, threads);
    };
  return one;
}

MicroCase rates_case(const Plugin& plugin, Model model, Precision precision, int n, int threads) {
  MicroCase one = plate_case(plugin, model, precision, n, threads);
  one.kernel = rates_kernel;
  one.flops = descriptor(model).flops.stage; // out = 0 + 1 f, as in the first stage of a step
  one.working_set_bytes =
      std::size_t(n) * std::size_t(n) * std::size_t(one.bytes) / std::size_t(threads);
  one.level = level_of(one.working_set_bytes);
  one.elements = double(n) * n * double(DeviceRates::launches_a_pass);
  one.make = [&plugin, model, precision, n, threads] {
    return std::make_unique<DeviceRates>(plugin, model, precision, n, threads);
  };
  one.error = [&plugin, model, precision, n, threads] {
    return rates_error(plugin, model, precision, n, threads);
  };
  return one;
}

std::vector<MicroCase> micro_cases(const MicroSet& set) {
  std::vector<const Plugin*> plugins;
  for (const VariantStatus& variant : asked_variants())
    if (variant.is_usable()) plugins.push_back(&load_variant(variant.name));
  require_known_names(set, plugins);
  std::vector<MicroCase> cases;
  for (const VariantStatus& variant : asked_variants()) {
    if (!has_name(set.variants, variant.name) ||
        (variant.is_by_name && has_name(set.variants, "*")))
      continue;
    if (variant.is_usable()) {
      add_kernels(set, load_variant(variant.name), cases);
      add_steps(set, load_variant(variant.name), cases);
    } else {
      MicroCase missing;
      missing.kernel = "*", missing.variant = variant.name, missing.isa = variant.isa,
      missing.skipped = variant.unusable;
      cases.push_back(missing);
    }
  }
  return cases;
}

} // namespace dss
