#include "experiments/studies/cluster/cluster_study.hpp"

#include "experiments/base/parallel.hpp"
#include "experiments/base/progress.hpp"
#include "experiments/base/text_table.hpp"
#include "experiments/measure/cell_study.hpp"
#include "experiments/run/cluster/simulation.hpp"
#include "experiments/run/plan/run_plan.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <span>

namespace dss {
namespace {

constexpr int simulated_steps = 20;

const std::vector<std::string>& simulated_columns() {
  static const std::vector<std::string> names = {"experiment",
                                                 "label",
                                                 "scene",
                                                 "set",
                                                 "elements",
                                                 "steps",
                                                 "ranks",
                                                 "network",
                                                 "latency_us",
                                                 "bandwidth_mb_per_s",
                                                 "decomposition",
                                                 "halo",
                                                 "paper_wall_s",
                                                 "paper_efficiency",
                                                 "measured_wall_s",
                                                 "simulated_paper_node_halo_used",
                                                 "simulated_paper_node_wall_s",
                                                 "simulated_paper_node_efficiency",
                                                 "simulated_paper_node_communication_s",
                                                 "simulated_paper_node_over_best",
                                                 "simulated_own_node_halo_used",
                                                 "simulated_own_node_wall_s",
                                                 "simulated_own_node_efficiency",
                                                 "simulated_own_node_communication_s",
                                                 "simulated_own_node_over_best",
                                                 "own_node_cores",
                                                 "own_node_element_steps_per_s",
                                                 "messages_per_step",
                                                 "bytes_per_step",
                                                 "status",
                                                 "reason"};
  return names;
}

/// Loads a scene with overrides and keeps the last one, because large scenes take seconds to load.
class LastScene {
public:
  explicit LastScene(std::string name) : name_(std::move(name)) {}
  const Scene& with(const std::vector<Override>& set) {
    if (!scene_ || set_text(set) != set_) {
      scene_.reset();
      scene_ = load_scene(name_, set);
      set_ = set_text(set);
    }
    return *scene_;
  }

private:
  std::string name_, set_;
  std::optional<Scene> scene_;
};

/// One problem on one number of ranks with one decomposition. All networks and strategies share it.
class SimulatedCase {
public:
  SimulatedCase(const SimulationBlock& block, const std::vector<Override>& set, const Scene& scene,
                int ranks, const std::string& decomposition, NodeSpeed base)
      : block_(block), set_(set), scene_(scene), ranks_(ranks),
        decomposition_(decompose(scene_.problem, decomposition, ranks)), base_(std::move(base)),
        own_(ranks == 1 ? base_ : of_node(own_speed(what(), decomposition_), block.node_cores)) {}

  static NodeSpeed speed_of_one(const Scene& scene, int node_cores) {
    return of_node(own_speed(simulated_problem(scene), decompose(scene.problem, "strips", 1)),
                   node_cores);
  }

  /// Rows of all strategies, network by network. Nothing is timed here, because the speeds of this
  /// machine are already known; so all cores may work.
  std::vector<Record> rows(const std::string& study, const std::vector<Platform>& platforms) const {
    const std::size_t halos = block_.halos.size();
    const Plans plans = make_plans();
    std::vector<Record> rows(platforms.size() * halos);
    for_each_on_all_cores(rows.size(), [&](std::size_t n) {
      rows[n] = row(study, plans, block_.platforms[n / halos], platforms[n / halos].path(),
                    block_.halos[n % halos]);
    });
    for (std::size_t first = 0; first < rows.size(); first += halos)
      for (const char* node : {"paper", "own"})
        put_over_best(std::span(rows).subspan(first, halos),
                      fmt::format("simulated_{}_node_", node));
    return rows;
  }

private:
  /// The computation and exchanges, on a published node and on a node like this machine.
  struct Plans {
    std::optional<SimulationPlan> paper;
    SimulationPlan own;
  };

  /// Speed of a node whose cores share nothing: an upper limit.
  static NodeSpeed of_node(NodeSpeed core, int cores) {
    core.stage_by_stage *= cores;
    core.at_once *= cores;
    return core;
  }

  SimulatedProblem what() const { return simulated_problem(scene_); }
  double elements() const { return double(scene_.problem.lattice.element_count); }

  /// One plan serves all networks and strategies; only the name of the strategy changes.
  Plans make_plans() const {
    const auto plan = [&](const NodeSpeed& speed) {
      return make_plan(what(), decomposition_, {&speed, 1}, "auto", simulated_steps,
                       block_.node_cores);
    };
    Plans plans{{}, plan(own_)};
    if (block_.published) plans.paper = plan(*published_speed());
    return plans;
  }

  std::optional<NodeSpeed> published_speed() const {
    if (!block_.published) return {};
    const PublishedNode& node = *block_.published;
    return given_speed("paper", node.elements * node.steps / node.wall_s, what().method);
  }

  Record row(const std::string& study, const Plans& plans, const std::string& network,
             const std::string& platform, const std::string& halo) const {
    Record row = {
        {"experiment", study},
        {"label", block_.label},
        {"scene", scene_.name},
        {"set", set_text(set_)},
        {"elements", fmt::format("{}", scene_.problem.lattice.element_count)},
        {"steps", fmt::format("{}", block_.steps)},
        {"ranks", fmt::format("{}", ranks_)},
        {"network", network},
        {"decomposition", decomposition_.method},
        {"halo", halo},
        {"own_node_cores", fmt::format("{}", block_.node_cores)},
        {"own_node_element_steps_per_s", number_text(own_.at_once / what().method.stages)},
        {"status", "ok"}};
    if (const auto paper = block_.paper_wall_s.find(ranks_); paper != block_.paper_wall_s.end()) {
      row["paper_wall_s"] = number_text(paper->second);
      row["paper_efficiency"] = number_text(block_.paper_wall_s.at(1) / paper->second / ranks_);
    }
    if (plans.paper)
      put_run(*plans.paper, *published_speed(), platform, halo, "simulated_paper_node_", row);
    put_run(plans.own, base_, platform, halo, "simulated_own_node_", row);
    return row;
  }

  /// @param base  speed of one rank with the whole problem; for weak scaling, with the share of one
  /// rank
  void put_run(SimulationPlan plan, const NodeSpeed& base, const std::string& platform,
               const std::string& halo, const std::string& column, Record& row) const {
    plan.halo = halo;
    const double alone_s = elements() * what().method.stages / base.at_once;
    try {
      const SimulatedRun run = simulate(plan, platform);
      row[column + "halo_used"] = run.halo;
      row[column + "wall_s"] = number_text(run.step_s * double(block_.steps));
      row[column + "communication_s"] =
          number_text(run.communication_s_per_step * double(block_.steps));
      row[column + "efficiency"] = number_text(alone_s / run.step_s / ranks_);
      row["messages_per_step"] = number_text(run.messages_per_step);
      row["bytes_per_step"] = number_text(run.bytes_per_step);
      row["latency_us"] = number_text(1e6 * run.latency_s);
      if (run.seconds_a_byte > 0)
        row["bandwidth_mb_per_s"] = number_text(1e-6 / run.seconds_a_byte);
    } catch (const InputError& error) {
      row["status"] = "failed";
      row["reason"] = error.what();
    }
  }

  /// Slowdown of each strategy relative to the best of the rows. It judges the choice of the cost
  /// model.
  static void put_over_best(std::span<Record> rows, const std::string& column) {
    double best = INFINITY;
    for (const Record& row : rows)
      if (const double wall_s = number_in(row, column + "wall_s"); wall_s < best) best = wall_s;
    for (Record& row : rows)
      if (const double wall_s = number_in(row, column + "wall_s"); !std::isnan(wall_s))
        row[column + "over_best"] = number_text(wall_s / best - 1);
  }

  const SimulationBlock& block_;
  const std::vector<Override>& set_;
  const Scene& scene_;
  int ranks_;
  Decomposition decomposition_;
  NodeSpeed base_, own_;
};

/// Adds the measured time of the same problem with the same ranks and strategy, scaled to the same
/// number of steps. Only for the network of this machine.
void put_measured(const Table& measured, Record& row) {
  if (text_in(row, "network") != host_platform) return;
  for (const Record& other : measured.rows)
    if (text_in(other, "scene") == text_in(row, "scene") &&
        text_in(other, "set") == text_in(row, "set") &&
        text_in(other, "ranks") == text_in(row, "ranks") && text_in(other, "threads") == "1" &&
        (text_in(row, "ranks") == "1" ||
         (text_in(other, "halo") == text_in(row, "halo") &&
          text_in(other, "decomposition") == text_in(row, "decomposition"))) &&
        text_in(other, "variant") == load_variant("auto").name &&
        text_in(other, "model") == "spatial" && text_in(other, "precision") == "f64" &&
        text_in(other, "integrator") == "rk4" && text_in(other, "status") == "ok")
      row["measured_wall_s"] = number_text(number_in(other, "measured_wall_s") *
                                           number_in(row, "steps") / number_in(other, "steps"));
}

} // namespace

Table simulate_study(const std::string& study, const std::vector<SimulationBlock>& blocks,
                     const Table& measured) {
  Table table{simulated_columns(), {}};
  if (const std::string why = why_no_simulation(); !why.empty()) {
    table.rows.push_back({{"experiment", study}, {"status", "skipped"}, {"reason", why}});
    return table;
  }
  Progress progress;
  for (const SimulationBlock& block : blocks) {
    const std::vector<Platform> platforms(block.platforms.begin(), block.platforms.end());
    LastScene scenes(block.scene);
    const bool is_weak = !block.set_of_ranks.empty();
    const std::vector<std::vector<Override>> no_sets(1);
    for (const auto& own_set : is_weak ? no_sets : block.sets) {
      const NodeSpeed base = SimulatedCase::speed_of_one(
          scenes.with(is_weak ? block.set_of_ranks.at(block.ranks.front()) : own_set),
          block.node_cores);
      for (const int ranks : block.ranks) {
        const auto& set = is_weak ? block.set_of_ranks.at(ranks) : own_set;
        for (const std::string& decomposition :
             ranks == 1 ? std::vector<std::string>{"strips"} : block.decompositions) {
          progress.note(fmt::format("simulation: {} {}, {} ranks, {}", block.scene, set_text(set),
                                    ranks, decomposition));
          for (Record& row : SimulatedCase(block, set, scenes.with(set), ranks, decomposition, base)
                                 .rows(study, platforms)) {
            put_measured(measured, row);
            table.rows.push_back(std::move(row));
          }
        }
      }
    }
  }
  return table;
}

std::string simulation_text(const Table& table) {
  std::vector<std::vector<std::string>> rows;
  for (const Record& row : table.rows) {
    const auto node = [&](const std::string& name) {
      const std::string column = fmt::format("simulated_{}_node_", name);
      return std::vector<std::string>{shown(row, column + "wall_s", "{:.4g}"),
                                      shown(row, column + "efficiency", "{:.3f}")};
    };
    std::vector<std::string> cells = {text_in(row, "set"),
                                      text_in(row, "ranks"),
                                      text_in(row, "network"),
                                      text_in(row, "decomposition"),
                                      text_in(row, "halo"),
                                      shown(row, "paper_wall_s", "{:.4g}"),
                                      shown(row, "paper_efficiency", "{:.3f}"),
                                      shown(row, "measured_wall_s", "{:.4g}")};
    for (const char* name : {"paper", "own"})
      for (std::string& cell : node(name)) cells.push_back(std::move(cell));
    cells.push_back(text_in(row, "status") == "ok"
                        ? ""
                        : text_in(row, "status") + ": " + text_in(row, "reason"));
    rows.push_back(std::move(cells));
  }
  return text_table({"set", "ranks", "network", "parts", "halo", "paper [s]", "eff.",
                     "measured [s]", "paper's node [s]", "eff.", "our node [s]", "eff.", "note"},
                    rows);
}

} // namespace dss
