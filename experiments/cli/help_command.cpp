#include "experiments/cli/commands.hpp"
#include "experiments/cli/man_page.hpp"
#include "solver/error.hpp"
#include "solver/nearest_name.hpp"

#include <fmt/format.h>
#include <memory>

namespace dss {
namespace {

struct HelpArguments {
  std::string command;
  bool is_page = false;
};

int print_help(const CLI::App& app, const HelpArguments& arguments) {
  if (arguments.is_page && !arguments.command.empty())
    throw InputError("help --man: is one page for all commands; give no COMMAND");
  if (arguments.is_page) {
    fmt::print("{}", man_page(app));
    return exit_success;
  }
  const CLI::App* asked = arguments.command.empty() ? &app : find_command(app, arguments.command);
  if (asked == nullptr)
    throw InputError(fmt::format("help {}: unknown command; {}", arguments.command,
                                 nearest_name(arguments.command, command_names(app))));
  const std::string program = app.get_name();
  fmt::print("{}", asked == &app
                       ? app.get_formatter()->make_help(&app, program, CLI::AppFormatMode::Normal)
                       : asked->help(program));
  return exit_success;
}

} // namespace

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
  return names;
}

const CLI::App* find_command(const CLI::App& app, const std::string& name) {
  for (const CLI::App* command : app.get_subcommands(nullptr))
    if (command->get_name() == name) return command;
  return nullptr;
}

void add_help_command(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand(
      "help", "Print the help of the program or of a command, or the manual page");
  const auto arguments = std::make_shared<HelpArguments>();
  command->add_option("COMMAND", arguments->command, "A command (default: the program itself)");
  command->add_flag("--man", arguments->is_page,
                    "Print the manual page of all commands, for man(1)");
  command->footer("Example: dssbench help verify\n         dssbench help --man | man -l -");
  command->callback([arguments, &app, &chosen] {
    chosen = [arguments, &app] { return print_help(app, *arguments); };
  });
}

} // namespace dss
