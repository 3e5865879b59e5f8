/// The extension module `dssbench._core`. The package's __init__.py is what users import.
#include "experiments/base/build_info.hpp"
#include "kernels/fields.hpp"
#include "python/core/simulation.hpp"
#include "solver/error.hpp"
#include "solver/numerics/stability.hpp"
#include "solver/scene/scene.hpp"
#include "variants/loading/loader.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <utility>

namespace py = pybind11;
using namespace pybind11::literals;

namespace dss {
namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

template <std::size_t width>
py::array_t<double> array_of(const std::vector<std::array<double, width>>& rows) {
  py::array_t<double> array({rows.size(), width});
  std::copy_n(rows.data()->data(), rows.size() * width, array.mutable_data());
  return array;
}

/// The simulation's own numbers, which live as long as the array: nothing is copied.
py::array state_of(py::object self) {
  const std::span<const double> state = self.cast<Simulation&>().state();
  py::array_t<double> array({state.size() / field_count, std::size_t(field_count)}, state.data(),
                            self);
  array.attr("setflags")("write"_a = false);
  return array;
}

py::array_t<double> von_mises_of(Simulation& simulation) {
  const std::vector<SymmetricTensor> stress = simulation.stress();
  py::array_t<double> array(py::ssize_t(stress.size()));
  std::ranges::transform(stress, array.mutable_data(), von_mises);
  return array;
}

void set_state(Simulation& simulation, const Array& state) {
  if (state.ndim() != 2 || state.shape(1) != field_count)
    throw InputError(fmt::format("state: give an array of shape (elements, {})", int(field_count)));
  simulation.set_state({state.data(), std::size_t(state.size())});
}

/// Advances in chunks, so that Ctrl-C ends it. Other threads of Python run meanwhile.
void advance(Simulation& simulation, long steps) {
  simulation.require_possible(steps);
  while (true) {
    const long chunk = std::min(steps, simulation.chunk(steps));
    {
      const py::gil_scoped_release others_run;
      simulation.advance(chunk);
    }
    if ((steps -= chunk) <= 0) return;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
}

/// Keys and values of --set.
using Overrides = std::vector<std::pair<std::string, std::string>>;

std::vector<Override> overrides_of(const Overrides& set) {
  std::vector<Override> overrides;
  for (const auto& [key, value] : set) overrides.push_back({key, value});
  return overrides;
}

py::list variant_list() {
  py::list list;
  for (const VariantStatus& variant : listed_variants())
    list.append(
        py::dict("name"_a = variant.name, "isa"_a = variant.isa, "unusable"_a = variant.unusable));
  return list;
}

py::list scene_list() {
  py::list list;
  for (const SceneListing& scene : list_scenes())
    list.append(py::dict("name"_a = scene.name, "title"_a = scene.title, "path"_a = scene.path,
                         "parameters"_a = scene.parameters));
  return list;
}

double predicted_stable_step(const std::string& scene, const Overrides& set,
                             const std::string& integrator) {
  const Scene loaded = load_scene(scene, overrides_of(set));
  return stable_step(loaded.problem, require_method(integrator)).dt;
}

using Text = std::optional<std::string>;

std::unique_ptr<Simulation> made(const std::string& scene, const Overrides& set,
                                 const std::string& variant, int threads, const std::string& device,
                                 const std::string& hybrid, int tile, const Text& model,
                                 const Text& precision, const Text& integrator,
                                 const Text& rotation, std::optional<double> dt, bool force) {
  RunRequest request;
  request.scene = scene;
  request.overrides = overrides_of(set);
  request.variant = variant;
  request.threads = threads;
  request.device = device;
  request.hybrid = hybrid;
  request.tile = tile;
  request.model = model;
  request.precision = precision;
  request.integrator = integrator;
  request.rotation = rotation;
  request.dt = dt;
  request.is_forced = force;
  return std::make_unique<Simulation>(std::move(request));
}

void bind_simulation(py::module_& module) {
  py::class_<Simulation>(module, "Simulation")
      .def(py::init(&made), "scene"_a, "set"_a, py::kw_only(), "variant"_a = "auto",
           "threads"_a = 1, "device"_a = "", "hybrid"_a = "", "tile"_a = 0, "model"_a = py::none(),
           "precision"_a = py::none(), "integrator"_a = py::none(), "rotation"_a = py::none(),
           "dt"_a = py::none(), "force"_a = false)
      .def("advance", &advance, "steps"_a)
      .def_property("state", &state_of, &set_state)
      .def("stress", [](Simulation& simulation) { return array_of(simulation.stress()); })
      .def("von_mises", &von_mises_of, "(elements,) [Pa]")
      .def("places", [](const Simulation& simulation) { return array_of(simulation.places()); })
      .def("write_picture", &Simulation::write_picture, "path"_a)
      .def_property_readonly("energy", &Simulation::energy)
      .def_property_readonly("digest", &Simulation::digest)
      .def_property_readonly("step", &Simulation::step)
      .def_property_readonly("time", &Simulation::time)
      .def_property_readonly("schedule", &Simulation::schedule)
      .def_property_readonly("name", [](const Simulation& s) { return s.problem().name; })
      .def_property_readonly("variant", [](const Simulation& s) { return s.plan().plugin->name; })
      .def_property_readonly("model", [](const Simulation& s) { return name(s.plan().model); })
      .def_property_readonly("integrator",
                             [](const Simulation& s) { return s.plan().method->name; })
      .def_property_readonly("precision",
                             [](const Simulation& s) { return name(s.plan().precision); })
      .def_property_readonly("dt", [](const Simulation& s) { return s.plan().dt; })
      .def_property_readonly("steps", [](const Simulation& s) { return s.plan().steps; })
      .def_property_readonly("stability_limit",
                             [](const Simulation& s) { return s.plan().stability_limit; })
      .def_property_readonly("elements",
                             [](const Simulation& s) { return s.problem().lattice.element_count; });
}

} // namespace
} // namespace dss

PYBIND11_MODULE(_core, module) {
  using namespace dss;
  py::register_exception<InputError>(module, "InputError", PyExc_ValueError);
  py::register_exception<UnstableError>(module, "UnstableError", PyExc_ArithmeticError);
  module.attr("field_names") = py::cast(field_names);
  module.attr("commit") = build_info().git_commit;
  module.attr("built_program") = DSS_PROGRAM;
  module.def("variants", &variant_list);
  module.def("scenes", &scene_list);
  module.def("stable_step", &predicted_stable_step, "scene"_a, "set"_a, "integrator"_a);
  bind_simulation(module);
}
