#include "solver/scene/scene.hpp"

#include "kernels/model.hpp"
#include "solver/error.hpp"
#include "solver/model/sufficiency/sufficiency.hpp"
#include "solver/numerics/method.hpp"
#include "solver/scene/constants.hpp"
#include "solver/scene/geometry.hpp"
#include "solver/scene/loads.hpp"
#include "solver/scene/method_name.hpp"
#include "solver/scene/terms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <new>
#include <stdexcept>

namespace dss {
namespace {

const std::vector<std::string> analyses = {"dynamic", "static", "modal"};

/// Numbers of the materials of voxels, ascending.
std::vector<int> material_numbers(const VoxelGrid& grid) {
  std::array<bool, 256> is_present{};
  for (const std::uint8_t cell : grid.occupied) is_present[cell] = true;
  std::vector<int> numbers;
  for (int number = 1; number < 256; ++number)
    if (is_present[std::size_t(number)]) numbers.push_back(number);
  return numbers;
}

/// Adds the numbers of a body's voxels to those of the elements.
void append_materials(const VoxelGrid& grid, Problem& problem) {
  const std::size_t count = problem.lattice.element_count;
  if (std::ranges::all_of(grid.occupied, [](std::uint8_t cell) { return cell <= 1; })) {
    if (!problem.materials.empty()) problem.materials.resize(count, 1);
    return;
  }
  problem.materials.reserve(count);
  problem.materials.resize(count - std::size_t(std::ranges::count_if(
                                       grid.occupied, [](auto cell) { return cell != 0; })),
                           1);
  for (const std::uint8_t cell : grid.occupied)
    if (cell != 0) problem.materials.push_back(cell);
}

Body read_body_properties(ObjectNode& object, const BodyShape& shape, Solids& solids) {
  Body body;
  body.name = object.require("name").name();
  body.edge = shape.edge;
  body.origin = shape.origin;
  solids.bodies.push_back(
      read_body_constants(object.require("constants"), material_numbers(shape.grid), body));
  return body;
}

void read_bodies(const Node& node, Problem& problem, Solids& solids, BodySurfaces& surfaces) {
  for (const Node& item : node.items()) {
    ObjectNode object(item);
    BodyShape shape = read_shape(object);
    const Body body = read_body_properties(object, shape, solids);
    object.finish();
    for (const Body& other : problem.bodies)
      if (other.name == body.name)
        object.require("name").fail(fmt::format("a second body \"{}\"; names differ", body.name));
    append_body(problem.lattice, shape.grid, int(problem.bodies.size()));
    append_materials(shape.grid, problem);
    problem.bodies.push_back(body);
    surfaces.push_back(std::move(shape.surface));
    if (problem.lattice.element_count > std::size_t(max_elements))
      object.require("geometry")
          .fail(fmt::format("{} elements so far are too many; a scene has at most {}",
                            problem.lattice.element_count, max_elements));
  }
  if (problem.bodies.empty()) node.fail("no bodies; a scene has at least one");
}

void read_terms(ObjectNode& root, const BodySurfaces& surfaces, Problem& problem, Solids& solids) {
  if (const auto links = root.find("extra_links"))
    read_extra_links(*links, surfaces, problem, solids);
  set_solid_links(solids, problem);
  if (const auto clamps = root.find("clamps")) read_clamps(*clamps, surfaces, problem);
  if (const auto loads = root.find("loads")) read_loads(*loads, solids, surfaces, problem);
  if (const auto ties = root.find("stabilization"))
    problem.stabilization = read_stabilization(*ties);
  if (const auto initial = root.find("initial")) read_initial_motions(*initial, surfaces, problem);
  if (const auto rotation = root.find("base_rotation"))
    problem.frame_rotation = read_frame_rotation(*rotation);
  problem.frame_acceleration =
      read_frame_acceleration(root.find("gravity"), root.find("base_acceleration"));
}

void read_run(const Node& node, Scene& scene) {
  ObjectNode run(node);
  scene.problem.dt = run.require("dt").positive();
  scene.problem.steps = run.require("steps").whole(1);
  const auto integrator = run.find("integrator"), model = run.find("model");
  scene.integrator = integrator ? method_name_in(*integrator) : "rk4";
  scene.problem.integrator = scene.integrator;
  scene.asked_model = model ? model->known_name("model", model_names_and_auto()) : "auto";
  scene.model = scene.asked_model == "auto" ? name(Model::spatial) : scene.asked_model;
  if (const std::string reason = why_not(*find_model(scene.model), scene.problem); !reason.empty())
    model->fail(
        fmt::format("\"{}\" does not hold: {}; use \"spatial\", or \"auto\"", scene.model, reason));
  const auto analysis = run.find("analysis");
  scene.analysis = analysis ? analysis->known_name("analysis", analyses) : analyses[0];
  run.finish();
}

VerifyCase read_verify_case(const Node& node) {
  ObjectNode object(node);
  VerifyCase verify;
  verify.steps = object.require("steps").whole(1);
  verify.set = nlohmann::json::object();
  if (const auto set = object.find("set")) {
    for (const auto& [key, change] : ObjectNode(*set).members())
      if (!change.json().is_number() && !change.is_string() && !change.json().is_boolean())
        change.fail("not a scalar; an override is a number, a text or true or false");
    verify.set = set->json();
  }
  object.finish();
  return verify;
}

std::vector<VerifyCase> read_verify(const std::optional<Node>& node, const Problem& problem) {
  if (!node) return {{nlohmann::json::object(), std::min(problem.steps, 100L)}};
  if (!node->is_array()) return {read_verify_case(*node)};
  std::vector<VerifyCase> cases;
  for (const Node& item : node->items()) cases.push_back(read_verify_case(item));
  if (cases.empty()) node->fail("no cases; give at least one, or leave \"verify\" out");
  return cases;
}

void read_tolerance(const std::optional<Node>& node, Tolerance& tolerance) {
  if (!node) return;
  ObjectNode object(*node);
  tolerance.evaluation = object.positive_or("evaluation", tolerance.evaluation);
  tolerance.run = object.positive_or("run", tolerance.run);
  object.finish();
}

void read_tolerances(ObjectNode& root, Problem& problem) {
  problem.tolerance_f64 = {1e-13, 1e-9};
  problem.tolerance_f32 = {1e-5, 1e-4};
  const auto node = root.find("tolerance");
  if (!node) return;
  ObjectNode object(*node);
  read_tolerance(object.find("f64"), problem.tolerance_f64);
  read_tolerance(object.find("f32"), problem.tolerance_f32);
  object.finish();
}

/// Head of a scene, as `list` shows it, and the keys that do not describe the problem.
SceneListing read_head(ObjectNode& root, const SceneText& text) {
  root.name_or("$schema", "");
  root.allow({"parameters", "fields"}); // already resolved
  if (const auto description = root.find("description")) description->text();
  return {root.require("scene").name(), root.require("title").text(), text.path, text.parameters};
}

Scene read_scene(const SceneText& text) {
  const Node whole(text);
  ObjectNode root(whole);
  Scene scene;
  const SceneListing head = read_head(root, text);
  scene.name = scene.problem.name = head.name;
  scene.title = head.title;
  scene.path = head.path;
  scene.parameters = head.parameters;
  const Node run = root.require("run");
  Solids solids;
  BodySurfaces surfaces;
  read_bodies(root.require("bodies"), scene.problem, solids, surfaces);
  read_terms(root, surfaces, scene.problem, solids);
  read_run(run, scene);
  read_tolerances(root, scene.problem);
  scene.verify = read_verify(root.find("verify"), scene.problem);
  root.finish();
  check_clamps(scene.problem, whole);
  return scene;
}

} // namespace

Scene load_scene(const std::string& name_or_path, const std::vector<Override>& overrides) {
  const std::string path = scene_path(name_or_path);
  try {
    return read_scene(read_scene_text(path, overrides));
  } catch (const std::bad_alloc&) {
    throw InputError(fmt::format(
        "{}: the scene does not fit into this machine's memory; give it fewer elements", path));
  } catch (const std::length_error&) {
    throw InputError(fmt::format(
        "{}: the scene does not fit into this machine's memory; give it fewer elements", path));
  }
}

ShapeSize scene_size(const std::string& name_or_path, const std::vector<Override>& overrides) {
  const SceneText text = read_scene_text(scene_path(name_or_path), overrides);
  const Node whole(text);
  ShapeSize size;
  for (const Node& item : ObjectNode(whole).require("bodies").items()) {
    ObjectNode body(item);
    const ShapeSize own = shape_size(body);
    size.cells += own.cells, size.least_elements += own.least_elements;
  }
  return size;
}

std::string scene_analysis(const std::string& name_or_path,
                           const std::vector<Override>& overrides) {
  const SceneText text = read_scene_text(scene_path(name_or_path), overrides);
  const nlohmann::json run =
      text.root.is_object() ? text.root.value("run", nlohmann::json()) : nlohmann::json();
  const bool is_given = run.is_object() && run.contains("analysis") && run["analysis"].is_string();
  return is_given ? run["analysis"].get<std::string>() : analyses[0];
}

std::vector<SceneListing> list_scenes() {
  std::vector<std::string> paths;
  const std::string directory = scene_directory();
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(directory, error))
    if (entry.path().extension() == ".json") paths.push_back(entry.path().string());
  if (error)
    throw InputError(fmt::format("scene directory {}: {}; set DSSBENCH_SCENES to one", directory,
                                 error.message()));
  std::sort(paths.begin(), paths.end());
  std::vector<SceneListing> scenes;
  for (const std::string& path : paths) {
    const SceneText text = read_scene_text(path, {});
    ObjectNode root{Node(text)};
    scenes.push_back(read_head(root, text));
  }
  return scenes;
}

std::vector<Override> verify_overrides(const VerifyCase& verify) {
  std::vector<Override> overrides;
  for (const auto& item : verify.set.items())
    overrides.push_back({item.key(), item.value().is_string() ? item.value().get<std::string>()
                                                              : item.value().dump()});
  overrides.push_back({"run.steps", std::to_string(verify.steps)});
  return overrides;
}

} // namespace dss
