#include "variants/mpi/world.hpp"

#include "solver/error.hpp"
#include "variants/mpi/start_guard.hpp"
#include "variants/mpi/watch.hpp"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <numeric>
#include <optional>
#include <sys/prctl.h>

namespace dss {
namespace {

World* world = nullptr;

/// Sets variables that MPI reads when it starts. Without mpirun a process is a job of its own, and
/// needs no daemon.
void prepare_environment() {
  // Copies from another process' memory fail in containers without ptrace.
  ::setenv("OMPI_MCA_btl_vader_single_copy_mechanism", "none", 0);
  if (!World::is_in_job()) ::setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
}

} // namespace

bool World::is_started() { return world != nullptr; }

bool World::is_in_job() {
  return std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr || std::getenv("PMIX_RANK") != nullptr;
}

World& World::instance() {
  if (world == nullptr) world = new World; // lives until the program ends, see end()
  return *world;
}

World::World() {
  prepare_environment();
  std::optional<StartGuard> guard;
  if (is_in_job()) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL); // a rank ends with its mpirun
    guard.emplace();
  }
  int provided = 0;
  if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided) != MPI_SUCCESS ||
      provided < MPI_THREAD_FUNNELED)
    throw InputError("variant mpi: MPI cannot be started with threads beside it");
  MPI_Comm_dup(MPI_COMM_WORLD, &comm_);
  MPI_Comm_rank(comm_, &rank_);
  MPI_Comm_size(comm_, &ranks_);
  MPI_Comm_split_type(comm_, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &node_);
  MPI_Comm_size(node_, &node_ranks_);
  if (ranks_ > 1) watch_ = std::make_shared<Watch>(comm_, node_);
}

std::vector<double> World::gather(double value) {
  std::vector<double> all(std::size_t(ranks_), value);
  const Waiting waiting(Waiting::for_all);
  MPI_Allgather(&value, 1, MPI_DOUBLE, all.data(), 1, MPI_DOUBLE, comm_);
  return all;
}

std::vector<std::string> World::gather(const std::string& text) {
  std::vector<int> sizes(std::size_t(ranks_), 0), places(sizes);
  const int size = int(text.size());
  const Waiting waiting(Waiting::for_all);
  MPI_Allgather(&size, 1, MPI_INT, sizes.data(), 1, MPI_INT, comm_);
  std::exclusive_scan(sizes.begin(), sizes.end(), places.begin(), 0);
  std::string all(std::size_t(places.back() + sizes.back()), ' ');
  MPI_Allgatherv(text.data(), size, MPI_CHAR, all.data(), sizes.data(), places.data(), MPI_CHAR,
                 comm_);
  std::vector<std::string> texts;
  for (std::size_t r = 0; r < sizes.size(); ++r)
    texts.push_back(all.substr(std::size_t(places[r]), std::size_t(sizes[r])));
  return texts;
}

void World::join(std::span<double> values) {
  if (ranks_ == 1) return;
  constexpr std::size_t most = std::size_t(1) << 24; // MPI counts with int
  for (std::size_t first = 0; first < values.size(); first += most) {
    const Waiting waiting(Waiting::for_all);
    MPI_Allreduce(MPI_IN_PLACE, &values[first], int(std::min(most, values.size() - first)),
                  MPI_UINT64_T, MPI_BOR, comm_);
  }
}

double World::least(double value) {
  const Waiting waiting(Waiting::for_all);
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_MIN, comm_);
  return value;
}

double World::largest(double value) { return -least(-value); }

void World::largest(std::span<double> values) {
  const Waiting waiting(Waiting::for_all);
  MPI_Allreduce(MPI_IN_PLACE, values.data(), int(values.size()), MPI_DOUBLE, MPI_MAX, comm_);
}

void World::meet() {
  const Waiting waiting(Waiting::for_all);
  MPI_Barrier(comm_);
}

void World::work_alone(bool is_alone) {
  if (watch_) watch_->work_alone(is_alone);
}

void World::end(int exit_code, bool is_in_order) {
  if (is_ended_) return;
  is_ended_ = true;
  if (!is_in_order && ranks_ > 1) MPI_Abort(comm_, exit_code);
  if (ranks_ > 1) meet(); // under the watch, which does not cover MPI_Finalize
  watch_.reset();
  MPI_Finalize();
}

} // namespace dss
