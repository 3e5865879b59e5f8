/// The program `dssbench`: command line, exit codes, and one line for every error.
#include "experiments/base/interrupt.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/cli/completion.hpp"
#include "experiments/run/plan/job.hpp"
#include "solver/error.hpp"
#include "solver/nearest_name.hpp"
#include "variants/loading/loader.hpp"
#include "variants/loading/outside.hpp"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <fmt/ranges.h>
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

/// Words of the command line that are neither options nor their values; at most `most`.
std::vector<std::string> plain_words(const std::vector<std::string>& words, const CLI::App& app,
                                     std::size_t most) {
  std::vector<std::string> plain;
  for (std::size_t place = 0; place < words.size() && plain.size() < most; ++place) {
    if (!words[place].starts_with("-"))
      plain.push_back(words[place]);
    else if (const CLI::Option* option = app.get_option_no_throw(words[place]);
             option != nullptr && option->get_items_expected_max() > 0)
      ++place;
  }
  return plain;
}

/// Checks the command. CLI11 would say only that a word was not expected; this message names the
/// nearest command.
/// @return the command, or nothing if only options are given
std::string require_known_command(const std::vector<std::string>& words, const CLI::App& app) {
  const std::vector<std::string> first = plain_words(words, app, 1);
  if (words.empty())
    throw InputError(fmt::format("give a command: {}; see dssbench --help",
                                 fmt::join(command_names(app), ", ")));
  if (first.empty()) return "";
  if (find_command(app, first[0]) != nullptr) return first[0];
  throw InputError(
      fmt::format("{}: unknown command; {}", first[0], nearest_name(first[0], command_names(app))));
}

/// Message about the first word that looks like an option but is unknown, with the nearest option;
/// empty if there is none.
std::string unknown_option(const std::vector<std::string>& words, const CLI::App& app,
                           const std::string& command) {
  std::vector<std::string> known;
  std::string letters;
  const auto add_names = [&](const CLI::App& of) {
    for (const CLI::Option* option : of.get_options()) {
      for (const std::string& name : option->get_snames()) letters += name;
      for (const std::string& name : option->get_lnames())
        if (std::find(known.begin(), known.end(), "--" + name) == known.end())
          known.push_back("--" + name);
    }
  };
  if (!command.empty()) add_names(*find_command(app, command));
  add_names(app);
  for (const std::string& whole : words) {
    const std::string word = whole.substr(0, whole.find('='));
    const bool is_long = word.size() > 2 && word.starts_with("--");
    const bool is_letter =
        word.size() > 1 && word[0] == '-' && std::isalpha(static_cast<unsigned char>(word[1])) != 0;
    if ((is_long && std::find(known.begin(), known.end(), word) == known.end()) ||
        (is_letter && letters.find(word[1]) == std::string::npos))
      return fmt::format("{}: unknown option; {}", word,
                         nearest_name(is_letter ? "-" + word : word, known));
  }
  return "";
}

/// Refuses other commands under mpirun: every rank would do the same work and write the same files.
void require_alone(const std::string& command) {
  require_usable_job();
  if (job_rank().ranks > 1 && command != "run" && command != "verify")
    throw InputError(fmt::format("{}: runs on one process and starts its own ranks where it needs "
                                 "them; run it without mpirun",
                                 command));
}

void describe(CLI::App& app, std::vector<std::string>& variant_path, Chosen& chosen) {
  std::string codes;
  for (std::size_t code = 0; code < exit_code_meanings.size(); ++code)
    codes += fmt::format("{}{} {}", code == 0 ? "" : ", ", code, exit_code_meanings[code]);
  app.description(
      "dssbench: dynamic stress-strain solvers, measured and checked\nExit codes: " + codes + ".");
  app.require_subcommand(1);
  app.set_version_flag("--version", "dssbench 0.1.0");
  app.add_option("--variant-path", variant_path,
                 "A directory of variants built outside the source tree, as examples/variant is; "
                 "may be repeated")
      ->type_name("DIR")
      ->allow_extra_args(false);
  app.footer(
      "Example: dssbench run plate_paper --set n=100 --steps 500 --threads 2\n"
      "Help of a command: dssbench run --help; the manual page: dssbench help --man | man -l -");
  for (const auto add :
       {add_list_command, add_run_command, add_explain_command, add_advise_command,
        add_verify_command, add_experiment_command, add_sweep_command, add_stability_command,
        add_compare_command, add_decompose_command, add_simulate_command, add_bench_command,
        add_completion_command, add_help_command})
    add(app, chosen);
  // they accept --variant-path too
  for (CLI::App* command : app.get_subcommands(nullptr)) command->fallthrough();
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

int run_program(int argc, char** argv) {
  const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  CLI::App app("", "dssbench");
  std::vector<std::string> variant_path;
  Chosen chosen;
  describe(app, variant_path, chosen);
  if (!words.empty() && words[0] == "complete") return complete(app, words);
  const std::string command = require_known_command(words, app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error); // help, version
    std::string what = unknown_option(words, app, command);
    if (what.empty()) what = error.what();
    what = what.substr(0, what.find('\n'));
    return fail(exit_bad_input, fmt::format("{}; see dssbench {}{}--help", what, command,
                                            command.empty() ? "" : " "));
  }
  require_alone(command);
  add_variant_path(variant_path);
  const int exit_code = chosen();
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
    return dss::run_program(argc, argv);
  } catch (const dss::UnstableError& error) {
    return dss::fail(dss::exit_unstable, error.what());
  } catch (const std::bad_alloc&) {
    return dss::fail(dss::exit_bad_input, "not enough memory for this problem; take a smaller one");
  } catch (const std::exception& error) {
    return dss::fail(dss::exit_bad_input, error.what());
  }
}
