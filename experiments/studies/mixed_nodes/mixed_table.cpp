#include "experiments/base/parallel.hpp"
#include "experiments/base/text_table.hpp"
#include "experiments/measure/cell_study.hpp"
#include "experiments/run/cluster/simulation.hpp"
#include "experiments/run/plan/run_plan.hpp"
#include "experiments/studies/mixed_nodes/mixed_study.hpp"
#include "solver/error.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <optional>

namespace dss {
namespace {

constexpr const char *equal = "equal", *by_speed = "by speed";

std::string text_of(const NodeMix& mix) {
  std::vector<std::string> kinds;
  for (const auto& [kind, count] : mix) kinds.push_back(fmt::format("{} {}", count, kind));
  return fmt::format("{}", fmt::join(kinds, " + "));
}

/// One problem on one mix of nodes, cut in one way. All networks and strategies share it.
class MixedCluster {
public:
  MixedCluster(const MixedStudy& study, const Scene& scene, const NodeMix& mix, bool is_by_speed)
      : study_(study), what_(simulated_problem(scene)) {
    Weights weights;
    for (const auto& [kind, count] : mix)
      for (int n = 0; n < count; ++n) {
        weights.speed.push_back(study.speeds.at(kind));
        speeds_.push_back(given_speed(kind, study.speeds.at(kind), what_.method));
      }
    const Decomposition decomposition =
        decompose(scene.problem, "strips", int(speeds_.size()), is_by_speed ? weights : Weights{});
    plan_ = make_plan(what_, decomposition, speeds_, "auto", mixed_simulated_steps);
    const std::vector<std::size_t> elements = part_elements(decomposition, scene.problem.lattice);
    for (std::size_t part = 0; part < elements.size(); ++part)
      longest_step_s_ = std::max(longest_step_s_, double(elements[part]) / weights.speed[part]);
  }

  std::size_t nodes() const { return speeds_.size(); }
  double ideal_wall_s() const { return double(study_.steps) * ideal_step_s(what_, speeds_); }
  /// Time of the slowest part over that of perfect balance, without exchanges.
  double imbalance() const { return longest_step_s_ / ideal_step_s(what_, speeds_); }
  SimulatedRun run(const Platform& platform, const std::string& halo) const {
    SimulationPlan plan = plan_;
    plan.halo = halo;
    return simulate(plan, platform.path());
  }

private:
  const MixedStudy& study_;
  const SimulatedProblem what_;
  std::vector<NodeSpeed> speeds_;
  SimulationPlan plan_;
  double longest_step_s_ = 0;
};

/// The nodes of the fastest kind.
NodeMix fastest_of(const MixedStudy& study, const NodeMix& mix) {
  return {*std::ranges::max_element(mix, {},
                                    [&](const auto& node) { return study.speeds.at(node.first); })};
}

/// Rows of one problem on one mix of nodes.
class MixedRows {
public:
  MixedRows(const MixedStudy& study, const MixedCase& one, const Scene& scene,
            const std::vector<Override>& set, const NodeMix& mix)
      : study_(study), case_(one), mix_(mix), set_(set),
        scene_(scene), clusters_{{equal, MixedCluster(study, scene, mix, false)},
                                 {by_speed, MixedCluster(study, scene, mix, true)}},
        fastest_(study, scene, fastest_of(study, mix), false) {}

  std::vector<Record> rows(const std::vector<Platform>& platforms) const {
    std::vector<Record> rows(platforms.size() * case_.halos.size() * clusters_.size());
    const std::size_t halos = case_.halos.size();
    for_each_on_all_cores(platforms.size() * halos, [&](std::size_t n) {
      put_pair(platforms[n / halos], case_.platforms[n / halos], case_.halos[n % halos],
               &rows[n * clusters_.size()]);
    });
    return rows;
  }

private:
  double wall_s(const SimulatedRun& run) const { return double(study_.steps) * run.step_s; }

  /// Writes a row of equal parts, and one of parts by speed.
  void put_pair(const Platform& platform, const std::string& network, const std::string& halo,
                Record* row) const {
    std::optional<double> equal_s, fastest_s;
    for (const auto& [shares, cluster] : clusters_) {
      *row = common(network, halo);
      (*row)["shares"] = shares;
      try {
        if (!fastest_s) fastest_s = wall_s(fastest_.run(platform, halo));
        const double time = put_run(cluster, cluster.run(platform, halo), *row);
        (*row)["fastest_alone_wall_s"] = number_text(*fastest_s);
        (*row)["over_fastest_alone"] = number_text(*fastest_s / time);
        if (shares == equal) equal_s = time;
        if (equal_s) (*row)["over_equal"] = number_text(*equal_s / time);
      } catch (const InputError& error) {
        (*row)["status"] = "failed";
        (*row)["reason"] = error.what();
      }
      ++row;
    }
  }

  /// @return the time of the study's steps [s]
  double put_run(const MixedCluster& cluster, const SimulatedRun& run, Record& row) const {
    const double time = wall_s(run), ideal = cluster.ideal_wall_s();
    row["halo_used"] = run.halo;
    row["imbalance"] = number_text(cluster.imbalance());
    row["simulated_wall_s"] = number_text(time);
    row["communication_s"] = number_text(run.communication_s_per_step * double(study_.steps));
    row["ideal_wall_s"] = number_text(ideal);
    row["efficiency"] = number_text(ideal / time);
    row["status"] = "ok";
    return time;
  }

  Record common(const std::string& network, const std::string& halo) const {
    return {{"experiment", study_.name},
            {"label", case_.label},
            {"scene", scene_.name},
            {"set", set_text(set_)},
            {"elements", fmt::format("{}", scene_.problem.lattice.element_count)},
            {"steps", fmt::format("{}", study_.steps)},
            {"nodes", text_of(mix_)},
            {"ranks", fmt::format("{}", clusters_.front().second.nodes())},
            {"network", network},
            {"halo", halo}};
  }

  const MixedStudy& study_;
  const MixedCase& case_;
  const NodeMix& mix_;
  const std::vector<Override>& set_;
  const Scene& scene_;
  std::vector<std::pair<std::string, MixedCluster>> clusters_;
  MixedCluster fastest_;
};

} // namespace

Table mixed_table(const MixedStudy& study, Progress& progress) {
  Table table{{"experiment",
               "label",
               "scene",
               "set",
               "elements",
               "steps",
               "nodes",
               "ranks",
               "network",
               "halo",
               "halo_used",
               "shares",
               "imbalance",
               "simulated_wall_s",
               "communication_s",
               "ideal_wall_s",
               "efficiency",
               "fastest_alone_wall_s",
               "over_fastest_alone",
               "over_equal",
               "status",
               "reason"},
              {}};
  if (const std::string why = why_no_simulation(); !why.empty()) {
    table.rows.push_back({{"experiment", study.name}, {"status", "skipped"}, {"reason", why}});
    return table;
  }
  for (const MixedCase& one : study.cases) {
    const std::vector<Platform> platforms(one.platforms.begin(), one.platforms.end());
    for (const auto& set : one.sets) {
      const Scene scene = load_scene(study.scene, set);
      for (const NodeMix& mix : one.mixes) {
        progress.note(
            fmt::format("mixed nodes: {} {}, {}", study.scene, set_text(set), text_of(mix)));
        try {
          for (Record& row : MixedRows(study, one, scene, set, mix).rows(platforms))
            table.rows.push_back(std::move(row));
        } catch (const InputError& error) { // such as more nodes than rows
          table.rows.push_back({{"experiment", study.name},
                                {"label", one.label},
                                {"scene", scene.name},
                                {"set", set_text(set)},
                                {"nodes", text_of(mix)},
                                {"status", "failed"},
                                {"reason", error.what()}});
        }
      }
    }
  }
  return table;
}

std::string mixed_text(const Table& mixed, const Table& held) {
  std::vector<std::vector<std::string>> clusters, pairs;
  for (const Record& row : mixed.rows)
    clusters.push_back(
        {text_in(row, "set"), text_in(row, "nodes"), text_in(row, "network"), text_in(row, "halo"),
         text_in(row, "shares"), shown(row, "simulated_wall_s", "{:.4g}"),
         shown(row, "efficiency", "{:.3f}"), shown(row, "over_fastest_alone", "{:.2f}"),
         shown(row, "over_equal", "{:.2f}"), text_in(row, "reason")});
  for (const Record& row : held.rows)
    pairs.push_back({text_in(row, "set"), text_in(row, "pairs"),
                     shown(row, "simulated_over_run", "{:.3f}"),
                     shown(row, "simulated_over_run_low", "{:.3f}"),
                     shown(row, "simulated_over_run_high", "{:.3f}"), text_in(row, "status")});
  return text_table({"set", "nodes", "network", "halo", "parts", "simulated [s]", "efficiency",
                     "over the fastest alone", "over equal parts", "note"},
                    clusters) +
         "\nSimulated steps over those of runs that exchange nothing:\n" +
         text_table({"set", "pairs", "simulated over run", "low", "high", "status"}, pairs);
}

} // namespace dss
