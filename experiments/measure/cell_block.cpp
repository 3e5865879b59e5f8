#include "experiments/measure/cell_block.hpp"
#include "experiments/measure/cell_devices.hpp"
#include "experiments/measure/study_file.hpp"
#include "experiments/measure/study_names.hpp"
#include "experiments/run/plan/job.hpp"
#include "experiments/run/plan/names.hpp"
#include "kernels/model.hpp"
#include "solver/decomposition/decomposition.hpp"
#include "solver/model/sufficiency/sufficiency.hpp"
#include "solver/scene/method_name.hpp"
#include "variants/api/distribution.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <optional>
#include <set>

namespace dss {
namespace {

/// Number of threads that stands for the word "fill": as many as fill the cores, for the ranks of
/// the cell.
constexpr int filling = 0;

/// Reads numbers of threads or ranks, in ascending order and without repeats.
std::vector<int> read_counts(ObjectNode& block, const char* key, int cores) {
  const auto node = block.find(key);
  if (!node) return {1};
  std::vector<int> numbers;
  for (const Node& item : node->list()) {
    if (item.json() == "cores")
      numbers.push_back(cores);
    else if (item.json() == "rest")
      numbers.push_back(std::max(1, cores - 1));
    else if (item.json() == "1..cores") {
      for (int number = 1; number <= cores; ++number) numbers.push_back(number);
    } else if (item.json() == "fill" && key == std::string_view("threads")) {
      numbers.push_back(filling);
    } else if (item.is_number()) {
      numbers.push_back(item.count(1));
    } else {
      item.fail(fmt::format("{} is neither a number of {} nor \"cores\", \"rest\" (all but one), "
                            "\"1..cores\"{}",
                            item.shown(), key,
                            key == std::string_view("threads") ? " nor \"fill\"" : ""));
    }
  }
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

/// True if a variant can use several threads; false if it cannot be opened.
bool is_threaded(const VariantStatus& status) {
  return status.is_usable() && load_variant(status.name).is_threaded;
}

/// True if a variant can compute a part, or cannot be opened. Those with implicit methods compute
/// whole problems only.
bool can_distribute(const VariantStatus& status) {
  if (!status.is_usable()) return true;
  const Plugin& plugin = load_variant(status.name);
  return !plugin.solves_equations();
}

/// Problems that grow with the ranks. A parameter is multiplied by ranks^(1 / power). The number of
/// elements goes with the parameter's power, so each rank keeps its number of elements.
struct WeakScaling {
  std::string parameter;
  long power = 1;
};

/// The values that a block of cells lists.
struct Block {
  std::string scene;
  Sets sets;
  std::vector<std::string> variants, models, precisions, integrators, decompositions, halos;
  std::vector<std::string> hybrids = {""};
  std::string device;
  std::vector<int> threads, ranks;
  std::vector<long> members; ///< of ensembles
  std::optional<WeakScaling> weak;
  std::vector<std::string> not_at; ///< scales that leave the block out
};

void read_ranks(ObjectNode& object, int cores, Block& block) {
  block.ranks = read_counts(object, "ranks", cores);
  if (block.ranks.back() > 1 && std::ranges::find(block.hybrids, "auto") != block.hybrids.end())
    object.require("ranks").fail(
        "members on ranks need names, \"avx512:1,opencl@gpu\" for one; \"auto\" is one process");
  block.decompositions = object.known_names_or("decompositions", "decomposition",
                                               names_of("DECOMPOSITION"), {"strips"});
  block.halos = object.known_names_or("halos", "halo strategy", names_of("HALO"), {"auto"});
  for (const std::string& variant : block.variants)
    if (block.ranks.back() > 1 && !can_distribute(known_variant(variant, object.node())))
      object.require("ranks").fail(fmt::format(
          "variant \"{}\" cannot compute parts, and runs on 1 rank; give it a block of its own",
          variant));
  const auto node = object.find("weak");
  if (!node) return;
  ObjectNode weak(*node);
  block.weak = {weak.require("parameter").name(), weak.require("power").whole(1)};
  weak.finish();
  if (block.ranks.front() != 1)
    weak.fail(
        "compares problems on several ranks with one on 1 rank; give \"ranks\" such as [1, 2, 4]");
}

/// Reads the members of a hybrid.
void read_hybrid(const Node& hybrid, ObjectNode& object, int cores, Block& block) {
  if (const auto variants = object.find("variants"))
    variants->fail(
        "a block has variants, or the members of a hybrid; give the other a block of its own");
  block.variants = {known_variant("hybrid", hybrid).name};
  block.hybrids.clear();
  for (const Node& item : hybrid.list()) block.hybrids.push_back(members_text(item, cores));
  const auto threads = object.find("threads");
  if (threads && block.hybrids != std::vector<std::string>{"auto"})
    threads->fail("the members of a hybrid name their threads: \"avx512:2,opencl@cpu:1\"");
}

void read_variants(ObjectNode& object, int cores, Block& block) {
  block.device = object.name_or("device", "");
  if (const auto hybrid = object.find("hybrid")) return read_hybrid(*hybrid, object, cores, block);
  const Node variants = object.require("variants");
  block.variants = variants.names();
  for (std::string& name : block.variants)
    if (name == "auto") name = load_variant(name).name; // records must name the variant that ran
  for (const std::string& name : block.variants)
    require_device_variant(name, block.device, variants);
}

Block read_block(ObjectNode& object, const StudyScales& scales, const CellRules& rules) {
  Block block;
  block.scene = object.require("scene").name();
  block.not_at = object.known_names_or("not_at", "scale", scales.names, {});
  for (const auto& own : combinations(object, "set"))
    for (const auto& of_scale : scales.sets) {
      block.sets.push_back(own);
      block.sets.back().insert(block.sets.back().end(), of_scale.begin(), of_scale.end());
    }
  read_variants(object, rules.cores, block);
  block.threads = read_counts(object, "threads", rules.cores);
  block.models = object.known_names_or("models", "model", model_names(), {"spatial"});
  block.precisions =
      object.known_names_or("precisions", "precision", names_of("PRECISION"), {"f64"});
  block.integrators = {"rk4"};
  if (const auto integrators = object.find("integrators")) {
    block.integrators.clear();
    for (const Node& item : integrators->list()) block.integrators.push_back(method_name_in(item));
  }
  read_ranks(object, rules.cores, block);
  block.members = {1};
  if (const auto ensemble = object.find("ensemble")) {
    const std::vector<int> counts = ensemble->counts(1);
    block.members.assign(counts.begin(), counts.end());
    if (block.ranks.back() > 1 || !block.hybrids.front().empty())
      ensemble->fail("members run side by side on one rank without hybrids; give ranks and hybrids "
                     "a block of their own");
  }
  object.allow(rules.block_keys);
  object.finish();
  return block;
}

/// Overrides of a weak scaling on this number of ranks.
/// @param parameter  its place in the file
std::vector<Override> grown(std::vector<Override> set, const WeakScaling& weak, int ranks,
                            const Node& parameter) {
  const auto last = std::find_if(set.rbegin(), set.rend(),
                                 [&](const Override& o) { return o.key == weak.parameter; });
  if (last == set.rend())
    parameter.fail(
        fmt::format("neither the block's set nor the scale's has \"{}\", from which problems grow",
                    weak.parameter));
  char* end = nullptr;
  const double value = std::strtod(last->value.c_str(), &end);
  if (*end != '\0' || !(value >= 1) || value != std::floor(value))
    parameter.fail(
        fmt::format("{}={} is not a whole number that can grow", last->key, last->value));
  last->value =
      fmt::format("{}", std::lround(value * std::pow(double(ranks), 1 / double(weak.power))));
  return set;
}

/// Replaces each cell by copies with every value of one member.
template <class Value>
void multiply(std::vector<Cell>& cells, const std::vector<Value>& values, Value Cell::*member) {
  std::vector<Cell> more;
  for (const Cell& cell : cells)
    for (const Value& value : values) {
      more.push_back(cell);
      more.back().*member = value;
    }
  cells = std::move(more);
}

/// Gives cells that fill the cores their threads. Drops those that another number of threads names
/// as well.
std::vector<Cell> filled(const std::vector<Cell>& cells, int cores) {
  std::set<std::string> named;
  for (const Cell& cell : cells) named.insert(cell.key());
  std::vector<Cell> all;
  for (Cell cell : cells) {
    const bool is_filling = cell.threads == filling;
    if (is_filling) cell.threads = std::max(1, cores / cell.ranks);
    if (!is_filling || !named.contains(cell.key())) all.push_back(cell);
  }
  return all;
}

std::vector<Cell> combined(const Block& block, int cores) {
  std::vector<Cell> cells(1);
  cells[0].scene = block.scene;
  multiply(cells, block.sets, &Cell::set);
  multiply(cells, block.models, &Cell::model);
  multiply(cells, block.precisions, &Cell::precision);
  multiply(cells, block.integrators, &Cell::integrator);
  multiply(cells, block.variants, &Cell::variant);
  multiply(cells, block.hybrids, &Cell::hybrid);
  multiply(cells, block.threads, &Cell::threads);
  multiply(cells, block.ranks, &Cell::ranks);
  multiply(cells, block.members, &Cell::members);
  multiply(cells, block.decompositions, &Cell::decomposition);
  multiply(cells, block.halos, &Cell::halo);
  std::erase_if(cells, [&](const Cell& cell) { // one process exchanges nothing
    return cell.ranks == 1 &&
           (cell.decomposition != block.decompositions[0] || cell.halo != block.halos[0]);
  });
  return filled(cells, cores);
}

/// Reason why a cell cannot run here, or empty. Missing devices are tested elsewhere, earlier.
std::string why_skipped(const Cell& cell, const VariantStatus& status) {
  if (!status.is_usable()) return status.unusable;
  if (const std::string why = why_no_members(cell.hybrid); !why.empty()) return why;
  if (cell.ranks == 1) return "";
  if (const HaloStrategy* halo = find_halo_strategy(cell.halo);
      halo != nullptr && !halo->is_possible(cell.threads))
    return fmt::format("halo {} is not possible with several threads", cell.halo);
  const std::string why = why_no_ranks();
  return why.empty() ? why_no_decomposition(cell.decomposition) : why;
}

/// Steps of a cell before `steps_for`.
long steps_of(const Scale& scale, const Cell& cell) {
  const auto own = scale.steps_by_set.find(cell.set_text());
  return own == scale.steps_by_set.end() ? scale.steps : own->second;
}

/// Smallest of the steps for the cell's overrides, for its variant, and for both together.
long steps_of_variant(const Scale& scale, const Cell& cell) {
  long steps = steps_of(scale, cell);
  for (const std::string& key : {cell.variant, cell.variant + " " + cell.set_text()})
    if (const auto fewer = scale.steps_for.find(key); fewer != scale.steps_for.end())
      steps = std::min(steps, fewer->second);
  return steps;
}

std::vector<Cell> cells_of(ObjectNode& object, const Block& block, const Scale& scale, int cores) {
  std::vector<Cell> cells = combined(block, cores);
  std::erase_if(cells, [&](const Cell& cell) {
    return cell.threads > 1 && !is_threaded(known_variant(cell.variant, object.node()));
  });
  // A larger problem on more workers than cores takes long and shows nothing.
  if (block.weak) std::erase_if(cells, [&](const Cell& c) { return c.is_oversubscribed(cores); });
  for (Cell& cell : cells) {
    cell.device = block.device;
    if (!cell.hybrid.empty() && cell.hybrid != "auto")
      cell.threads = std::max(1, threads_of_members(cell.hybrid) / cell.ranks);
    if (block.weak) {
      cell.weak_base_set = cell.set_text();
      cell.set = grown(cell.set, *block.weak, cell.ranks,
                       ObjectNode(object.require("weak")).require("parameter"));
    }
    cell.skipped = why_no_device(cell);
    cell.is_unavailable = !cell.skipped.empty();
    if (!cell.is_unavailable)
      cell.skipped = why_skipped(cell, known_variant(cell.variant, object.node()));
    cell.full_steps = scale.full_steps > 0 ? scale.full_steps : steps_of(scale, cell);
    cell.steps = steps_of_variant(scale, cell);
  }
  return cells;
}

/// Rejects blocks that can never run: an unknown scene or override, or a model that lacks the
/// scene's degrees of freedom.
void require_loadable(const Node& place, const Block& block, const std::vector<Cell>& cells) {
  std::set<std::string> loaded;
  for (const Cell& cell : cells) {
    if (!loaded.insert(cell.set_text()).second) continue;
    const Scene scene = place.placed([&] { return load_scene(cell.scene, cell.set); });
    for (const std::string& model : block.models)
      if (const std::string why = why_not(*find_model(model), scene.problem); !why.empty())
        place.fail(fmt::format("model \"{}\": {}", model, why));
  }
}

} // namespace

void add_block(const Node& place, const StudyScales& scales, const CellRules& rules,
               CellStudy& study) {
  ObjectNode object(place);
  const Block block = read_block(object, scales, rules);
  std::vector<Cell> cells = cells_of(object, block, study.scale, rules.cores);
  require_loadable(place, block, cells);
  if (rules.expand) cells = rules.expand(object, cells);
  if (std::ranges::find(block.not_at, study.scale.name) != block.not_at.end()) return;
  std::set<std::string> keys;
  for (const Cell& cell : cells) {
    if (!keys.insert(cell.key()).second)
      place.fail(fmt::format("the same cell twice: {}", cell.key()));
    const auto same = std::find_if(study.cells.begin(), study.cells.end(),
                                   [&](const Cell& other) { return other.key() == cell.key(); });
    if (same == study.cells.end())
      study.cells.push_back(cell);
    else if (same->weak_base_set.empty())
      same->weak_base_set = cell.weak_base_set;
    else if (!cell.weak_base_set.empty() && same->weak_base_set != cell.weak_base_set)
      object.require("weak").fail(fmt::format("{} belongs to the weak scaling from {} already",
                                              cell.key(), same->weak_base_set));
  }
}

} // namespace dss
