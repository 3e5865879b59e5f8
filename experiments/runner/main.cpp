/// The program `dssbench`: command line, exit codes, and one line for every error.
#include "experiments/runner/commands.hpp"
#include "experiments/runner/job.hpp"
#include "solver/error.hpp"
#include "solver/nearest_name.hpp"
#include "variants/loader.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <fmt/format.h>
#include <new>
#include <string>
#include <thread>
#include <vector>

namespace dss {
namespace {

/// Of several ranks the first one speaks: what it says ends the others, and only what it does not say is theirs to say.
int fail(int exit_code, const std::string& what) {
  if (!job_rank().is_root()) std::this_thread::sleep_for(std::chrono::seconds(1));
  fmt::print(stderr, "dssbench: {}\n", what);
  end_variants(exit_code, false);
  return exit_code;
}

/// CLI11 says only that an unknown word was not expected; the user should hear what would be right.
void require_known_command(int argc, char** argv, const CLI::App& app) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::vector<std::string> known;
  for (const CLI::App* command : app.get_subcommands(nullptr)) known.push_back(command->get_name());
  for (const std::string& name : known)
    if (name == argv[1]) return;
  throw InputError(fmt::format("{}: unknown command; {}", argv[1], nearest_name(argv[1], known)));
}

/// The first word that looks like an option of a command but is none, with the nearest that is; else empty.
std::string unknown_option(int argc, char** argv, const CLI::App& app) {
  std::vector<std::string> known;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App* one) { return one->parsed(); }))
    for (const CLI::Option* option : command->get_options())
      if (!option->get_lnames().empty()) known.push_back("--" + option->get_lnames().front());
  for (int place = 2; place < argc; ++place) {
    const std::string word = std::string(argv[place]).substr(0, std::string(argv[place]).find('='));
    if (word.starts_with("--") && std::find(known.begin(), known.end(), word) == known.end())
      return fmt::format("{}: unknown option; {}", word, nearest_name(word, known));
  }
  return "";
}

/// All other commands would do the same on every rank, and write the same files.
void require_alone(const std::string& command) {
  require_usable_job();
  if (job_rank().ranks > 1 && command != "run" && command != "verify")
    throw InputError(fmt::format(
        "{}: runs on one process and starts its own ranks where it needs them; run it without mpirun", command));
}

int run_program(int argc, char** argv) {
  CLI::App app("dssbench: dynamic stress-strain solvers, measured and checked.\n"
               "Exit codes: 0 success, 1 a check failed, 2 bad input, 3 a run is or would be unstable.");
  app.require_subcommand(1);
  app.set_version_flag("--version", "dssbench 0.1.0");
  app.footer(
      "Example: dssbench run plate_paper --set n=100 --steps 500 --threads 2\nHelp of a command: dssbench run --help");
  Chosen chosen;
  add_list_command(app, chosen);
  add_run_command(app, chosen);
  add_explain_command(app, chosen);
  add_advise_command(app, chosen);
  add_verify_command(app, chosen);
  add_experiment_command(app, chosen);
  add_stability_command(app, chosen);
  add_compare_command(app, chosen);
  add_decompose_command(app, chosen);
  add_simulate_command(app, chosen);
  add_bench_command(app, chosen);
  require_known_command(argc, argv, app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error); // help, version
    std::string what = unknown_option(argc, argv, app);
    if (what.empty()) what = error.what();
    what = what.substr(0, what.find('\n'));
    return fail(exit_bad_input,
                fmt::format("{}; see dssbench {} --help", what, argc > 1 && argv[1][0] != '-' ? argv[1] : ""));
  }
  for (const CLI::App* command : app.get_subcommands()) require_alone(command->get_name());
  const int exit_code = chosen();
  end_variants(exit_code, true);
  if (std::fflush(stdout) != 0) throw InputError("standard output: cannot write; is the disk full?");
  return exit_code;
}

} // namespace
} // namespace dss

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN); // a limit on file sizes then is an error of write(), told like a full disk
  if (!dss::job_rank().is_root() && std::freopen("/dev/null", "w", stdout) == nullptr) return dss::exit_bad_input;
  try {
    return dss::run_program(argc, argv);
  } catch (const dss::UnstableError& error) {
    return dss::fail(dss::exit_unstable, error.what());
  } catch (const std::bad_alloc&) {
    return dss::fail(dss::exit_bad_input, "not enough memory for this problem; take a smaller one");
  } catch (const std::exception& error) {
    return dss::fail(dss::exit_bad_input, error.what());
  }
}
