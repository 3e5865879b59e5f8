#include "experiments/run/plan/job.hpp"

#include "experiments/base/child.hpp"
#include "experiments/base/exit_code.hpp"
#include "solver/cores.hpp"
#include "solver/error.hpp"
#include "variants/loading/loader.hpp"
#include "variants/loading/outside.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <limits>
#include <regex>
#include <sstream>
#include <unistd.h>

namespace dss {
namespace {

/// Environment variables of a rank: Open MPI; PMIx with Slurm (srun --mpi=pmix); PMI.
constexpr const char* rank_names[][2] = {{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                                         {"PMIX_RANK", "SLURM_STEP_NUM_TASKS"},
                                         {"PMI_RANK", "PMI_SIZE"}};

std::string mpirun_path() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "/usr/bin" : path);
  for (std::string folder; std::getline(folders, folder, ':');)
    if (const std::string file = folder + "/mpirun"; ::access(file.c_str(), X_OK) == 0) return file;
  return {};
}

std::vector<std::string> own_arguments() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> arguments;
  for (std::string argument; std::getline(file, argument, '\0');) arguments.push_back(argument);
  return arguments;
}

/// One line that says why a job failed, from the output of the ranks and of mpirun.
std::string failure_line(const ChildResult& job, int ranks) {
  std::istringstream lines(job.error);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("dssbench: ")) return line;
  if (job.error.find("not enough slots") != std::string::npos)
    return fmt::format("dssbench: --ranks {}: mpirun has not so many slots here (inside another "
                       "job, or an allocation)",
                       ranks);
  std::smatch match;
  if (std::regex_search(job.error, match,
                        std::regex("process rank (\\d+) .*exited on signal (\\d+) \\(([^)]*)\\)")))
    return fmt::format("dssbench: rank {} of {} was ended by signal {} ({})", match.str(1), ranks,
                       match.str(2), match.str(3));
  if (std::regex_search(
          job.error, match,
          std::regex("Process name: \\[\\[\\d+,\\d+\\],(\\d+)\\]\\s+Exit code: +(\\d+)")))
    return fmt::format("dssbench: rank {} of {} ended with exit code {}", match.str(1), ranks,
                       match.str(2));
  return fmt::format("dssbench: mpirun: {}", job.failure(0));
}

} // namespace

JobRank job_rank() {
  for (const auto& [rank_name, size_name] : rank_names) {
    const char *rank = std::getenv(rank_name), *size = std::getenv(size_name);
    if (rank != nullptr && size != nullptr)
      return {std::atoi(rank), std::max(1, std::atoi(size)), true};
  }
  return {};
}

void require_usable_job() {
  const char* tasks = std::getenv("SLURM_STEP_NUM_TASKS");
  if (tasks != nullptr && std::atoi(tasks) > 1 && !job_rank().is_started)
    throw InputError(fmt::format(
        "srun has started {} tasks that MPI knows nothing of; start them by srun --mpi=pmix",
        tasks));
}

int most_ranks_here() { return std::max(64, 16 * usable_cores()); }

VariantName parse_variant(const std::string& text, int ranks) {
  if (text == "mpi") return {"mpi", "auto"};
  if (text.starts_with("mpi:")) return {"mpi", text.substr(4)};
  if (ranks > 1) return {"mpi", text};
  return {text, ""};
}

std::string why_no_ranks() {
  const auto& all = variants();
  const auto mpi = std::ranges::find(all, "mpi", &VariantStatus::name);
  if (mpi == all.end()) return "built without the variant mpi";
  if (!mpi->is_usable()) return mpi->unusable;
  return mpirun_path().empty() ? "mpirun is not installed (openmpi-bin)" : "";
}

JobResult run_job(int ranks, int threads, const std::vector<std::string>& arguments) {
  if (const std::string why = why_no_ranks(); !why.empty())
    throw InputError(fmt::format("--ranks {}: {}", ranks, why));
  std::vector<std::string> line = {"mpirun", "--oversubscribe", "-np", fmt::format("{}", ranks)};
  if (ranks * threads > usable_cores())
    line.insert(line.end(), {"--bind-to", "none"});
  else
    line.insert(line.end(), {"--map-by", fmt::format("slot:PE={}", threads), "--bind-to",
                             "core:overload-allowed"});
  if (std::getenv(variant_path_variable) != nullptr)
    line.insert(line.end(), {"-x", variant_path_variable});
  line.push_back(std::filesystem::read_symlink(this_program).string());
  line.insert(line.end(), arguments.begin(), arguments.end());
  ::setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 0); // containers often run as root
  ::setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 0);
  // Single-copy transfers fail in containers without ptrace.
  ::setenv("OMPI_MCA_btl_vader_single_copy_mechanism", "none", 0);
  // Without an allocation of nodes, all ranks are on this machine. To look for networks of a
  // cluster takes 0.2 s a start.
  const std::array allocations = {"SLURM_JOB_ID", "PBS_NODEFILE", "LSB_JOBID", "PE_HOSTFILE"};
  if (std::ranges::none_of(allocations, [](const char* name) { return std::getenv(name); }))
    ::setenv("OMPI_MCA_pml", "ob1", 0);
  const ChildResult job =
      run_child(mpirun_path(), line, std::numeric_limits<double>::infinity(), true);
  JobResult result{exit_success, job.output, job.error, ""};
  if (job.exit_code == exit_success && job.signal == 0) return result;
  const bool is_own = job.exit_code == exit_bad_input || job.exit_code == exit_unstable;
  result.exit_code = is_own ? job.exit_code : exit_check_failed;
  result.failure = failure_line(job, ranks);
  return result;
}

int run_on_ranks(int ranks, int threads) {
  std::vector<std::string> arguments = own_arguments();
  arguments.erase(arguments.begin());
  const JobResult job = run_job(ranks, threads, arguments);
  fmt::print("{}", job.output);
  fmt::print(stderr, "{}", job.failure.empty() ? job.error : job.failure + "\n");
  return job.exit_code;
}

} // namespace dss
