#include "experiments/cli/command_line.hpp"

#include "experiments/base/build_info.hpp"
#include "experiments/cli/arguments.hpp"
#include "solver/error.hpp"
#include "solver/nearest_name.hpp"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace dss {
namespace {

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

/// Version, commit and build, for reports of mistakes.
std::string version_text() {
  const BuildInfo& build = build_info();
  std::vector<std::string> packages;
  for (const auto& [name, version] : build.packages)
    packages.push_back(fmt::format("{} {}", name, version));
  return fmt::format("dssbench 0.1.0, commit {}{}\nbuilt by {}, {} {}\nwith {}",
                     build.git_commit.empty() ? "unknown" : build.git_commit.substr(0, 12),
                     build.git_dirty ? " with uncommitted changes" : "", build.compiler,
                     build.build_type, build.flags, fmt::join(packages, ", "));
}

} // namespace

CommandLine::CommandLine() : app_("", "dssbench") {
  std::string codes;
  for (std::size_t code = 0; code < exit_code_meanings.size(); ++code)
    codes += fmt::format("{}{} {}", code == 0 ? "" : ", ", code, exit_code_meanings[code]);
  app_.description(
      "dssbench: dynamic stress-strain solvers, measured and checked\nExit codes: " + codes + ".");
  app_.require_subcommand(1);
  app_.set_version_flag("--version", version_text);
  app_.add_option("--variant-path", variant_path_,
                  "A directory of variants built outside the source tree, as examples/variant is; "
                  "may be repeated")
      ->type_name("DIR")
      ->allow_extra_args(false);
  app_.footer(
      "Example: dssbench run plate_paper --set n=100 --steps 500 --threads 2\n"
      "Help of a command: dssbench run --help; the manual page: dssbench help --man | man -l -");
#define DSS_ADD(name) add_##name##_command(app_, chosen_);
  DSS_EACH_COMMAND(DSS_ADD)
#undef DSS_ADD
  // they accept --variant-path too
  for (CLI::App* command : app_.get_subcommands(nullptr)) command->fallthrough();
}

void CommandLine::parse(const std::vector<std::string>& all) {
  command_ = require_known_command(all, app_);
  // Their words may look like options, or like lists of CLI11: [a,b].
  const auto mark = command_ == "compare" ? std::ranges::find(all, "--") : all.end();
  const std::vector<std::string> words(all.begin(), mark);
  words_after_mark().assign(mark == all.end() ? mark : mark + 1, all.end());
  try {
    app_.parse(std::vector<std::string>(words.rbegin(), words.rend())); // it wants the last first
  } catch (const CLI::Success&) {
    throw;
  } catch (const CLI::ParseError& error) {
    std::string what = unknown_option(words, app_, command_);
    if (what.empty()) what = error.what();
    throw InputError(fmt::format("{}; see dssbench {}{}--help", what.substr(0, what.find('\n')),
                                 command_, command_.empty() ? "" : " "));
  }
}

} // namespace dss
