#include "variants/mpi/start_guard.hpp"

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <unistd.h>

namespace dss {
namespace {

namespace fs = std::filesystem;
constexpr double default_patience_s = 7;
constexpr int exit_hung = 70;

/// Value of a variable in the environment of a process; empty if it is not set.
std::string variable_of(const fs::path& process, const std::string& name) {
  std::ifstream file(process / "environ", std::ios::binary);
  for (std::string line; std::getline(file, line, '\0');)
    if (line.starts_with(name + "=")) return line.substr(name.size() + 1);
  return {};
}

/// Rank of a stopped process that has the same parent as this one, or empty.
std::string stopped_rank() {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator("/proc", error)) {
    std::ifstream file(entry.path() / "stat");
    std::string text;
    if (!std::getline(file, text)) continue;
    char state = 0;
    int parent = 0;
    const std::size_t name_end = text.rfind(')');
    if (name_end == std::string::npos ||
        std::sscanf(text.c_str() + name_end + 1, " %c %d", &state, &parent) != 2)
      continue;
    if ((state == 'T' || state == 't') && parent == ::getppid())
      return variable_of(entry.path(), "OMPI_COMM_WORLD_RANK");
  }
  return {};
}

} // namespace

double patience_s() {
  const char* text = std::getenv("DSSBENCH_PATIENCE_S");
  const double asked = text == nullptr ? 0 : std::atof(text);
  return asked > 0 ? asked : default_patience_s;
}

void end_job(const std::string& what) {
  const std::string line = fmt::format("dssbench: {}; the job is ended\n", what);
  const auto written = ::write(2, line.data(), line.size());
  ::_exit(written < 0 ? exit_hung + 1 : exit_hung);
}

StartGuard::StartGuard() : thread_([this] { look(); }) {}

StartGuard::~StartGuard() {
  {
    const std::lock_guard lock(mutex_);
    is_started_ = true;
  }
  started_.notify_one();
  thread_.join();
}

void StartGuard::look() {
  std::unique_lock lock(mutex_);
  const char* ranks = std::getenv("OMPI_COMM_WORLD_SIZE"); // a start of many processes takes longer
  const auto limit =
      std::chrono::duration<double>(patience_s() + 0.2 * (ranks == nullptr ? 0 : std::atoi(ranks)));
  if (started_.wait_for(lock, limit, [&] { return is_started_; })) return;
  const std::string rank = stopped_rank();
  end_job(rank.empty() ? fmt::format("MPI has not started in {:g} s: a rank is missing or hangs",
                                     patience_s())
                       : fmt::format("rank {} is stopped, and MPI cannot start without it", rank));
}

} // namespace dss
