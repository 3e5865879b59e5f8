/// A job on a simulated cluster (SimGrid SMPI). It runs the exchange code of the variant `mpi`
/// unchanged; compute times are injected in place of executors. Argument: the plan (plan.hpp).
/// Prints one JSON object; any other output is a failure.
#include "solver/error.hpp"
#include "variants/cost/halo_cost.hpp"
#include "variants/mpi/halo_exchange.hpp"
#include "variants/mpi/network.hpp"
#include "variants/mpi/simulated/plan.hpp"
#include "variants/mpi/transports.hpp"
#include "variants/mpi/waiting.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <string>

namespace dss {
namespace {

/// All ranks live in one process and share its globals, so one of them reads the plan.
const SimulationPlan& the_plan(const char* path) {
  static const SimulationPlan plan =
      nlohmann::json::parse(std::ifstream(path)).get<SimulationPlan>();
  return plan;
}

/// Memory of all messages. Their content does not matter, and SimGrid need not copy shared memory.
std::byte* the_message(std::size_t bytes) {
  static std::byte* const memory = static_cast<std::byte*>(SMPI_SHARED_MALLOC(bytes));
  return memory;
}

std::size_t largest_message(const SimulationPlan& plan) {
  std::size_t bytes = 1;
  for (const PlannedStrategy& strategy : plan.strategies)
    for (const PlannedPart& part : strategy.parts)
      for (const PlannedPart::Face& face : part.faces)
        bytes = std::max({bytes, face.send_bytes, face.receive_bytes});
  return bytes;
}

void compute(double seconds) {
  if (seconds > 0) smpi_execute(seconds);
}

/// The steps of one part under one strategy.
class SimulatedPart {
public:
  SimulatedPart(const PlannedStrategy& planned, const HaloStrategy& strategy, int rank,
                std::byte* message)
      : planned_(planned), strategy_(strategy), part_(planned.parts[std::size_t(rank)]) {
    std::vector<Face> faces;
    for (const PlannedPart::Face& face : part_.faces)
      faces.push_back({face.part, face.side, faces.size()});
    exchange_ = make_exchange(strategy.transport, std::move(faces), MPI_COMM_WORLD);
    exchange_->attach(copies_, [&, message](const Face& face, Way way, int) {
      const PlannedPart::Face& planned_face = part_.faces[face.number];
      const std::size_t bytes =
          way == Way::out ? planned_face.send_bytes : planned_face.receive_bytes;
      return HaloLayout{{{message, 0, bytes}}, bytes, true};
    });
  }

  void run(int steps) {
    const int last = steps * planned_.exchanges - 1;
    for (const Side side : all_sides) exchange_->send(side, 0);
    for (int n = 0; n <= last; ++n)
      run_to_next_exchange(strategy_, part_.times, planned_.exchanges, *exchange_, n, n == last,
                           compute);
  }
  const Traffic& traffic() const { return exchange_->traffic(); }

private:
  static constexpr int copies_ = 2;
  const PlannedStrategy& planned_;
  const HaloStrategy& strategy_;
  const PlannedPart& part_;
  std::unique_ptr<HaloExchange> exchange_;
};

double largest(double value) {
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  return value;
}
double sum(double value) {
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  return value;
}

constexpr double in_step_s = 0.1; ///< longer than a reduction over all ranks [s]
/// With more ranks the model alone decides, because SimGrid would take minutes to try strategies.
constexpr std::size_t most_tried_ranks = 64;

/// What a run measured.
struct SimulatedSteps {
  double step_s = 0, waited_s = 0;
  Traffic traffic; ///< sent by this rank
};

SimulatedSteps run(const PlannedStrategy& planned, int steps, int rank, std::byte* message) {
  SimulatedPart part(planned, *find_halo_strategy(planned.name), rank, message);
  // All ranks start at the same time. If they left a barrier one after the other, they could stay
  // out of step for the whole run where messages dominate.
  const double start = largest(MPI_Wtime()) + in_step_s;
  const double until_start = start - MPI_Wtime();
  if (until_start < 0)
    throw InputError("a reduction over all ranks takes longer than 0.1 s on this network");
  compute(until_start);
  const double waited_before_s = Waiting::total_s();
  part.run(steps);
  const double run_s = MPI_Wtime() - start, waited_s = Waiting::total_s() - waited_before_s;
  return {largest(run_s) / steps, waited_s, part.traffic()};
}

using StepTimes = std::map<std::string, double>;

/// The predictions are the same for all ranks, so one of them replays.
const StepTimes& the_predictions(const SimulationPlan& plan, const Network& network) {
  static const StepTimes step_s = [&] {
    StepTimes times;
    for (const PlannedStrategy& planned : plan.strategies)
      times.emplace(planned.name, predicted_step_s(planned, network));
    return times;
  }();
  return step_s;
}

/// Whether to run a strategy: the one asked for; for auto those that may be the fastest, as in
/// variants/mpi/strategy_choice.cpp.
bool is_run(const std::string& name, const SimulationPlan& plan, const StepTimes& predicted) {
  if (plan.halo != "auto") return name == plan.halo;
  const auto least = std::ranges::min_element(predicted, {}, &StepTimes::value_type::second);
  const bool is_small = plan.strategies.front().parts.size() <= most_tried_ranks;
  return is_small ? predicted.at(name) <= worth_trying * least->second : name == least->first;
}

void simulate(const SimulationPlan& plan, int rank) {
  const Network network = measure_network(MPI_COMM_WORLD);
  const StepTimes& predicted = the_predictions(plan, network);
  std::map<std::string, SimulatedSteps> tried;
  for (const PlannedStrategy& planned : plan.strategies)
    if (is_run(planned.name, plan, predicted))
      tried.emplace(planned.name,
                    run(planned, plan.steps, rank, the_message(largest_message(plan))));
  const auto& [halo, result] =
      *std::ranges::min_element(tried, {}, [](const auto& one) { return one.second.step_s; });
  const double steps = plan.steps;
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  nlohmann::ordered_json json{{"halo", halo},
                              {"step_s", result.step_s},
                              {"messages_per_step", sum(result.traffic.messages) / steps},
                              {"bytes_per_step", sum(result.traffic.bytes) / steps},
                              {"communication_s_per_step", sum(result.waited_s) / ranks / steps},
                              {"latency_s", network.latency_s},
                              {"seconds_a_byte", network.seconds_a_byte}};
  for (const auto& [name, seconds] : predicted) json["predicted_step_s"][name] = seconds;
  for (const auto& [name, steps_run] : tried) json["tried_step_s"][name] = steps_run.step_s;
  if (rank == 0) fmt::print("{}\n", json.dump());
}

} // namespace
} // namespace dss

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  MPI_Init(nullptr, nullptr);
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  try {
    dss::simulate(dss::the_plan(argv[1]), rank);
  } catch (const std::exception& error) {
    fmt::print(stderr, "dssbench: rank {}: {}\n", rank, error.what());
    std::_Exit(1); // MPI_Abort would end with exit code 0 here
  }
  MPI_Finalize();
  return 0;
}
