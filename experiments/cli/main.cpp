/// The program `dssbench`: exit codes, and one line for every error.
#include "experiments/base/interrupt.hpp"
#include "experiments/base/thread_stacks.hpp"
#include "experiments/cli/command_line.hpp"
#include "experiments/cli/completion.hpp"
#include "experiments/run/plan/job.hpp"
#include "solver/error.hpp"
#include "variants/loading/loader.hpp"
#include "variants/loading/outside.hpp"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <new>
#include <string>
#include <thread>
#include <vector>

namespace dss {
namespace {

/// An error as one line that a terminal can show: users' texts may have line breaks, escape
/// sequences and thousands of characters. Only the log of a compiler has more lines.
std::string shown(const std::string& what) {
  constexpr std::size_t most = 1200, at_end = 300;
  const std::size_t log = what.find("its log:\n");
  std::string line;
  for (const char c : what.substr(0, log))
    if (c == '\n')
      line += "\\n";
    else
      line += std::iscntrl(static_cast<unsigned char>(c)) != 0 ? '?' : c;
  if (line.size() > most)
    line = fmt::format("{} ... ({} characters) ... {}", line.substr(0, most - at_end),
                       line.size() - most, line.substr(line.size() - at_end));
  return log == std::string::npos ? line : line + what.substr(log);
}

/// Prints an error and ends. Rank 0 prints at once, and its end stops the other ranks. The other
/// ranks wait 1 s, so that they print only errors that rank 0 does not have.
int fail(int exit_code, const std::string& what) {
  if (!job_rank().is_root()) std::this_thread::sleep_for(std::chrono::seconds(1));
  fmt::print(stderr, "dssbench: {}\n", shown(what));
  end_variants(exit_code, false);
  return exit_code;
}

/// Refuses other commands under mpirun: every rank would do the same work and write the same files.
void require_alone(const std::string& command) {
  require_usable_job();
  if (job_rank().ranks > 1 && command != "run" && command != "verify")
    throw InputError(fmt::format("{}: runs on one process and starts its own ranks where it needs "
                                 "them; run it without mpirun",
                                 command));
}

/// Directories of --variant-path in a line that is being typed. Shells pass it unprocessed: bash
/// with a separate word "=", all with an unexpanded ~.
std::vector<std::string> typed_variant_path(std::vector<std::string> words) {
  std::erase(words, "=");
  const std::string option = "--variant-path", prefix = option + "=";
  const char* home = std::getenv("HOME");
  std::vector<std::string> directories;
  for (std::size_t place = 0; place < words.size(); ++place) {
    std::string directory;
    if (words[place].starts_with(prefix))
      directory = words[place].substr(prefix.size());
    else if (words[place] == option && place + 1 < words.size())
      directory = words[++place];
    if (home != nullptr && (directory == "~" || directory.starts_with("~/")))
      directory.replace(0, 1, home);
    if (!directory.empty()) directories.push_back(directory);
  }
  return directories;
}

/// Answers completion scripts: one completion per line. `words` begin with "complete".
int complete(const CLI::App& app, const std::vector<std::string>& words) {
  const std::vector<std::string> before(words.begin() + 1,
                                        words.end() - (words.size() > 1 ? 1 : 0));
  for (const std::string& directory : typed_variant_path(before)) {
    try {
      add_variant_path({directory});
    } catch (const InputError&) { // running the line reports the error; completing it does not
    }
  }
  for (const std::string& completion : completions(app, {words.begin() + 1, words.end()}))
    fmt::print("{}\n", completion);
  return exit_success;
}

int run_program(const std::vector<std::string>& words) {
  CommandLine line;
  if (!words.empty() && words[0] == "complete") return complete(line.app(), words);
  try {
    line.parse(words);
  } catch (const CLI::Success& help_or_version) {
    return line.app().exit(help_or_version);
  }
  require_alone(line.command());
  require_thread_stacks();
  add_variant_path(line.variant_path());
  const int exit_code = line.run();
  end_variants(exit_code, true);
  if (std::fflush(stdout) != 0)
    throw InputError("standard output: cannot write; is the disk full?");
  return exit_code;
}

} // namespace
} // namespace dss

int main(int argc, char** argv) {
  // Exceeding a limit on file sizes then is an error of write(), reported like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  dss::handle_interrupts(dss::job_rank().is_started);
  if (!dss::job_rank().is_root() && std::freopen("/dev/null", "w", stdout) == nullptr)
    return dss::exit_bad_input;
  try {
    return dss::run_program({argv + std::min(argc, 1), argv + argc});
  } catch (const dss::UnstableError& error) {
    return dss::fail(dss::exit_unstable, error.what());
  } catch (const std::bad_alloc&) {
    return dss::fail(dss::exit_bad_input, "not enough memory for this problem; take a smaller one");
  } catch (const std::exception& error) {
    return dss::fail(dss::exit_bad_input, error.what());
  }
}
