/// METIS: k-way partition of the graph of links.
#include "solver/decomposition/methods.hpp"
#include "solver/error.hpp"

#include <fmt/format.h>

#ifdef DSS_HAS_METIS
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <limits>
#include <metis.h>
#include <numeric>
#endif

namespace dss {

#ifndef DSS_HAS_METIS

std::string why_no_metis() { return "built without METIS; install libmetis-dev and build again"; }

std::vector<Share> divide_by_metis(const Division&) {
  throw InputError("method metis: " + why_no_metis());
}

#else
namespace {

/// Neighbours of each element in the form of METIS. Those of element e are neighbour[first[e]] ..
/// neighbour[first[e + 1] - 1].
struct Graph {
  std::vector<idx_t> first, neighbour, weight;
  idx_t size() const { return idx_t(first.size()) - 1; }
};

/// METIS wants each link once in each direction. So extra links that repeat another extra link or a
/// link of the grid are left out.
std::vector<std::pair<std::size_t, std::size_t>> extra_pairs(const Division& division) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const ExtraLink& link : division.problem.extra_links) {
    const Cell i = division.grid.cell_of(link.i), j = division.grid.cell_of(link.j);
    const Row& row = division.grid.row(i.row);
    const bool is_beside = i.x == j.x && (row.lower_y == j.row || row.upper_y == j.row ||
                                          row.lower_z == j.row || row.upper_z == j.row);
    const bool is_in_row = i.row == j.row && std::abs(i.x - j.x) <= 1;
    if (!is_beside && !is_in_row) pairs.push_back(std::minmax(link.i, link.j));
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

/// Weights as whole numbers, with three digits for the smallest if the sum allows it.
std::vector<idx_t> whole_weights(const Division& division) {
  const auto& cost = division.body_cost;
  if (std::adjacent_find(cost.begin(), cost.end(), std::not_equal_to<>()) == cost.end()) return {};
  double sum = 0;
  division.grid.lattice().for_each_element(
      [&](std::size_t, const Row& row, int) { sum += cost[std::size_t(row.body)]; });
  const double scale =
      std::min(1000 / *std::min_element(cost.begin(), cost.end()), double(1 << 30) / sum);
  std::vector<idx_t> weight;
  division.grid.lattice().for_each_element([&](std::size_t, const Row& row, int) {
    weight.push_back(std::max(idx_t(1), idx_t(std::lround(cost[std::size_t(row.body)] * scale))));
  });
  return weight;
}

Graph graph_of(const Division& division) {
  const Lattice& lattice = division.grid.lattice();
  const auto extra = extra_pairs(division);
  const auto for_each_pair = [&](auto&& visit) {
    lattice.for_each_link([&](std::size_t i, std::size_t j, int) { visit(i, j); });
    for (const auto& [i, j] : extra) visit(i, j);
  };
  constexpr std::size_t most = std::numeric_limits<idx_t>::max();
  if (6 * lattice.element_count + 2 * extra.size() > most)
    throw InputError(fmt::format(
        "method metis: {} elements are more than this METIS can take ({} at most); use blocks",
        lattice.element_count, most / 6));
  Graph graph;
  graph.first.assign(lattice.element_count + 1, 0);
  for_each_pair([&](std::size_t i, std::size_t j) {
    ++graph.first[i + 1];
    ++graph.first[j + 1];
  });
  std::partial_sum(graph.first.begin(), graph.first.end(), graph.first.begin());
  graph.neighbour.resize(std::size_t(graph.first.back()));
  std::vector<idx_t> next(graph.first.begin(), graph.first.end() - 1);
  for_each_pair([&](std::size_t i, std::size_t j) {
    graph.neighbour[std::size_t(next[i]++)] = idx_t(j);
    graph.neighbour[std::size_t(next[j]++)] = idx_t(i);
  });
  graph.weight = whole_weights(division);
  return graph;
}

bool is_connected(const Graph& graph) {
  std::vector<std::uint8_t> is_seen(std::size_t(graph.size()), 0);
  std::vector<idx_t> front = {0};
  is_seen[0] = 1;
  idx_t count = 1;
  while (!front.empty()) {
    const auto element = std::size_t(front.back());
    front.pop_back();
    for (idx_t k = graph.first[element]; k < graph.first[element + 1]; ++k) {
      const idx_t other = graph.neighbour[std::size_t(k)];
      if (is_seen[std::size_t(other)]) continue;
      is_seen[std::size_t(other)] = 1;
      ++count;
      front.push_back(other);
    }
  }
  return count == graph.size();
}

/// Largest ratio of a part's share of the weight to its wanted share; infinite if a part is empty.
double imbalance(const Graph& graph, const std::vector<real_t>& wanted,
                 const std::vector<idx_t>& part) {
  std::vector<double> sum(wanted.size(), 0);
  for (std::size_t e = 0; e < part.size(); ++e)
    sum[std::size_t(part[e])] += graph.weight.empty() ? 1 : double(graph.weight[e]);
  const double all = std::accumulate(sum.begin(), sum.end(), 0.0);
  double worst = 0;
  for (std::size_t p = 0; p < sum.size(); ++p)
    worst = sum[p] > 0 ? std::max(worst, sum[p] / all / double(wanted[p]))
                       : std::numeric_limits<double>::infinity();
  return worst;
}

enum class Manner { k_way_contiguous, k_way, recursive };

/// Part of each element; empty if METIS fails.
std::vector<idx_t> partition(Graph& graph, std::vector<real_t>& wanted, Manner manner) {
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  options[METIS_OPTION_CONTIG] = manner == Manner::k_way_contiguous;
  idx_t elements = graph.size(), constraints = 1, parts = idx_t(wanted.size()), cut = 0;
  std::vector<idx_t> part(std::size_t(elements), 0);
  const auto function =
      manner == Manner::recursive ? METIS_PartGraphRecursive : METIS_PartGraphKway;
  const int status = function(&elements, &constraints, graph.first.data(), graph.neighbour.data(),
                              graph.weight.empty() ? nullptr : graph.weight.data(), nullptr,
                              nullptr, &parts, wanted.data(), nullptr, options, &cut, part.data());
  return status == METIS_OK ? part : std::vector<idx_t>{};
}

/// Contiguous parts if the bodies are connected and the balance is good; otherwise the best
/// balance.
std::vector<idx_t> best_partition(const Division& division) {
  Graph graph = graph_of(division);
  if (division.parts() == 1) return std::vector<idx_t>(std::size_t(graph.size()), 0);
  const double speed = std::accumulate(division.speed.begin(), division.speed.end(), 0.0);
  std::vector<real_t> wanted;
  for (const double one : division.speed) wanted.push_back(real_t(one / speed));
  std::vector<idx_t> best;
  double least = std::numeric_limits<double>::infinity();
  for (const Manner manner : {Manner::k_way_contiguous, Manner::k_way, Manner::recursive}) {
    if (manner == Manner::k_way_contiguous && !is_connected(graph)) continue;
    std::vector<idx_t> part = partition(graph, wanted, manner);
    const double excess =
        part.empty() ? std::numeric_limits<double>::infinity() : imbalance(graph, wanted, part);
    if (excess >= least) continue;
    least = excess;
    best = std::move(part);
    if (least <= 1.05) break;
  }
  if (best.empty())
    throw InputError(fmt::format(
        "method metis: METIS leaves one of {} parts without elements; take fewer parts, or blocks",
        division.parts()));
  return best;
}

} // namespace

std::string why_no_metis() { return ""; }

std::vector<Share> divide_by_metis(const Division& division) {
  const std::vector<idx_t> part = best_partition(division);
  std::vector<Share> shares;
  division.grid.for_each_run(division.grid.all(), [&](const Segment& run, std::size_t first) {
    for (int x = run.x_begin; x < run.x_end; ++x, ++first)
      if (!shares.empty() && shares.back().part == part[first] &&
          shares.back().segment.row == run.row && shares.back().segment.x_end == x)
        ++shares.back().segment.x_end;
      else
        shares.push_back({{run.row, x, x + 1}, int(part[first])});
  });
  return shares;
}

#endif
} // namespace dss
