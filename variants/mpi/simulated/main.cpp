/// A job on a simulated cluster (SimGrid SMPI): the exchange code of the variant `mpi` as it is; what its executors would
/// compute is injected as time. Argument: the plan (plan.hpp). Prints one JSON object; anything else is a failure.
#include "variants/halo_cost.hpp"
#include "variants/mpi/halo_exchange.hpp"
#include "variants/mpi/network.hpp"
#include "variants/mpi/simulated/plan.hpp"
#include "variants/mpi/waiting.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <fstream>
#include <limits>

namespace dss {
namespace {

/// All ranks live in one process and share its globals: one of them reads the plan.
const SimulationPlan& the_plan(const char* path) {
  static const SimulationPlan plan = nlohmann::json::parse(std::ifstream(path)).get<SimulationPlan>();
  return plan;
}

/// What is in the messages does not matter: all are the same memory, which SimGrid then need not copy.
std::byte* the_message(std::size_t bytes) {
  static std::byte* const memory = static_cast<std::byte*>(SMPI_SHARED_MALLOC(bytes));
  return memory;
}

std::size_t largest_message(const SimulationPlan& plan) {
  std::size_t bytes = 1;
  for (const PlannedStrategy& strategy : plan.strategies)
    for (const PlannedPart& part : strategy.parts)
      for (const PlannedPart::Face& face : part.faces) bytes = std::max({bytes, face.send_bytes, face.receive_bytes});
  return bytes;
}

void compute(double seconds) {
  if (seconds > 0) smpi_execute(seconds);
}

/// The steps of one part, in the order of variants/engine: staged.hpp and row_executor.cpp.
class SimulatedPart {
public:
  SimulatedPart(const PlannedStrategy& planned, const HaloStrategy& strategy, int rank, std::byte* message)
      : planned_(planned), strategy_(strategy), part_(planned.parts[std::size_t(rank)]) {
    std::vector<Face> faces;
    for (const PlannedPart::Face& face : part_.faces) faces.push_back({face.part, face.side, faces.size()});
    exchange_ = make_exchange(strategy.transport, std::move(faces), MPI_COMM_WORLD);
    exchange_->attach(copies_, [&, message](const Face& face, Way way, int) {
      const PlannedPart::Face& planned_face = part_.faces[face.number];
      const std::size_t bytes = way == Way::out ? planned_face.send_bytes : planned_face.receive_bytes;
      return HaloLayout{{{message, 0, bytes}}, bytes, true};
    });
  }

  void run(int steps) {
    for (const Side side : all_sides) exchange_->send(side, 0);
    for (int n = 0; n < steps; ++n) {
      const bool is_last = n + 1 == steps;
      if (strategy_.is_every_stage)
        step_by_stages(is_last);
      else if (strategy_.is_overlapped)
        overlapped_step(
            *exchange_, n % copies_, (n + 1) % copies_, is_last, part_.times.upper_s > 0,
            [&] { compute(part_.times.upper_s); },
            [&](auto&& edge_is_done) {
              compute(part_.times.edge_s);
              edge_is_done();
              compute(part_.times.compute_s - part_.times.upper_s - part_.times.edge_s);
            });
      else
        step_at_once(n, is_last);
    }
  }
  const Traffic& traffic() const { return exchange_->traffic(); }

private:
  void step_by_stages(bool is_last) {
    const double inner_s = strategy_.is_overlapped ? part_.times.inner_s / planned_.exchanges : 0;
    for (int stage = 0; stage < planned_.exchanges; ++stage) {
      compute(inner_s);
      for (const Side side : all_sides) exchange_->receive(side, 0);
      compute(part_.times.compute_s / planned_.exchanges - inner_s);
      if (is_last && stage + 1 == planned_.exchanges) return;
      for (const Side side : all_sides) exchange_->send(side, 0);
    }
  }
  void step_at_once(int n, bool is_last) {
    for (const Side side : all_sides) exchange_->receive(side, n % copies_);
    compute(part_.times.compute_s);
    if (is_last) return;
    for (const Side side : all_sides) exchange_->send(side, (n + 1) % copies_);
  }

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

double predicted_s(const PlannedStrategy& planned, const HaloStrategy& strategy, int rank, const Network& network) {
  const PlannedPart& part = planned.parts[std::size_t(rank)];
  HaloCost cost{part.times.compute_s,
                strategy.is_every_stage ? part.times.inner_s : part.times.compute_s - part.times.upper_s,
                planned.exchanges, int(part.faces.size()), 0};
  for (const PlannedPart::Face& face : part.faces) cost.bytes += double(face.send_bytes);
  return largest(predicted_step_s(strategy, cost, network));
}

void simulate(const SimulationPlan& plan, int rank) {
  const Network network = measure_network(MPI_COMM_WORLD);
  nlohmann::ordered_json json{{"latency_s", network.latency_s}, {"seconds_a_byte", network.seconds_a_byte}};
  const PlannedStrategy* chosen = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const PlannedStrategy& planned : plan.strategies) {
    const double step_s = predicted_s(planned, *find_halo_strategy(planned.name), rank, network);
    json["predicted_step_s"][planned.name] = step_s;
    const bool is_asked = plan.halo == planned.name;
    if (is_asked || (plan.halo == "auto" && step_s < least)) chosen = &planned, least = step_s;
  }
  const HaloStrategy& strategy = *find_halo_strategy(chosen->name);
  SimulatedPart part(*chosen, strategy, rank, the_message(largest_message(plan)));
  MPI_Barrier(MPI_COMM_WORLD);
  const double start = MPI_Wtime(), waited_before_s = Waiting::total_s();
  part.run(plan.steps);
  const double run_s = MPI_Wtime() - start, waited_s = Waiting::total_s() - waited_before_s;
  const double steps = plan.steps;
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  json["halo"] = strategy.name;
  json["step_s"] = largest(run_s) / steps;
  json["messages_per_step"] = sum(part.traffic().messages) / steps;
  json["bytes_per_step"] = sum(part.traffic().bytes) / steps;
  json["communication_s_per_step"] = sum(waited_s) / ranks / steps;
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
