#include "experiments/cli/man_page.hpp"

#include "experiments/base/environment.hpp"
#include "experiments/cli/commands.hpp"

#include <fmt/format.h>
#include <sstream>

namespace dss {
namespace {

/// Escapes text so that no character is a roff request.
std::string roff(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    const bool begins_line = safe.empty() || safe.back() == '\n';
    if (begins_line && (c == '.' || c == '\'')) safe += "\\&";
    if (c == '\\')
      safe += "\\e";
    else if (c == '-')
      safe += "\\-";
    else
      safe += c;
  }
  return safe;
}

std::string verbatim(const std::string& text) { return fmt::format(".nf\n{}\n.fi\n", roff(text)); }

/// Set by processes that link the library, such as those of Python.
constexpr EnvironmentVariable prefix_variable = {
    "DSSBENCH_PREFIX", "Prefix under which scenes and variants are installed; default: that of the "
                       "program, or the source and build trees."};

std::string entry_of(const EnvironmentVariable& variable) {
  return fmt::format(".TP\n\\fB{}\\fR\n{}\n", variable.name, roff(variable.meaning));
}

std::string option_entry(const CLI::Option& option) {
  const bool takes_value = !option.get_positional() && option.get_items_expected_max() > 0;
  std::string name = option.get_positional() ? option.get_name(true) : option.get_name(false, true);
  // "-h,--help"
  if (const std::size_t comma = name.find(','); comma != std::string::npos)
    name.insert(comma + 1, " ");
  std::string entry = fmt::format(".TP\n\\fB{}\\fR", roff(name));
  if (takes_value) entry += fmt::format(" \\fI{}\\fR", roff(option.get_type_name()));
  std::string text = option.get_description();
  if (!option.get_default_str().empty())
    text += fmt::format(" (default: {})", option.get_default_str());
  return entry + "\n" + roff(text) + "\n";
}

std::string option_entries(const CLI::App& app) {
  std::string entries;
  for (const bool is_positional : {true, false})
    for (const CLI::Option* option : app.get_options())
      if (option->get_positional() == is_positional && !option->get_group().empty())
        entries += option_entry(*option);
  return entries;
}

std::string synopsis(const CLI::App& command) {
  std::string line = fmt::format("\\fBdssbench {}\\fR", roff(command.get_name()));
  for (const CLI::Option* option : command.get_options())
    if (option->get_positional()) {
      const std::string name = fmt::format("\\fI{}\\fR{}", roff(option->get_name(true)),
                                           option->get_items_expected_max() > 1 ? "..." : "");
      line += option->get_required() ? " " + name : fmt::format(" [{}]", name);
    }
  return line + " [\\fIOPTION\\fR...]";
}

std::string command_section(const CLI::App& command) {
  std::string text = fmt::format(".SS {}\n{}\n.PP\n{}\n", roff(command.get_name()),
                                 synopsis(command), roff(command.get_description()));
  return text + option_entries(command) + ".PP\n" + verbatim(command.get_footer());
}

} // namespace

std::string man_page(const CLI::App& app) {
  std::istringstream lines(app.get_description());
  std::string summary;
  std::getline(lines, summary);
  const std::string version = app.version();
  std::string page = fmt::format(".TH DSSBENCH 1 \"\" \"{}\" \"User Commands\"\n.SH NAME\n{}\n",
                                 version.substr(0, version.find(',')), // without the commit
                                 roff(summary.replace(summary.find(": "), 2, " - ")));
  page +=
      ".SH SYNOPSIS\n\\fBdssbench\\fR [\\fIOPTION\\fR...] \\fICOMMAND\\fR [\\fIARGUMENT\\fR...]\n";
  page += ".SH OPTIONS\nFor every command, before it or after.\n" + option_entries(app) +
          ".SH COMMANDS\n";
  for (const CLI::App* command : app.get_subcommands(nullptr)) page += command_section(*command);
  page += ".SH EXIT STATUS\n";
  for (std::size_t code = 0; code < exit_code_meanings.size(); ++code)
    page += fmt::format(".TP\n{}\n{}\n", code, roff(exit_code_meanings[code]));
  page += ".SH ENVIRONMENT\n";
  for (const EnvironmentVariable& variable : environment_variables) page += entry_of(variable);
  page += entry_of(prefix_variable);
  return page + ".SH EXAMPLES\n" + verbatim(app.get_footer());
}

} // namespace dss
