#include "experiments/cli/commands.hpp"
#include "experiments/run/plan/names.hpp"
#include "solver/error.hpp"
#include "solver/nearest_name.hpp"

#include <fmt/format.h>
#include <map>
#include <memory>

namespace dss {
namespace {

/// Each script calls `dssbench complete WORD...`, so completions always fit the installed program.
constexpr const char* bash_script = R"sh(_dssbench() {
  mapfile -t COMPREPLY < <("${COMP_WORDS[0]}" complete "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
  if [[ ${#COMPREPLY[@]} == 1 && ${COMPREPLY[0]} == *= ]]; then compopt -o nospace; fi
}
complete -o default -F _dssbench dssbench
)sh";
constexpr const char* zsh_script = R"sh(#compdef dssbench
_dssbench() {
  local -a found
  found=(${(f)"$("${words[1]}" complete "${(@)words[2,CURRENT]}" 2>/dev/null)"})
  if (( ${#found} )); then compadd -- $found; else _files; fi
}
compdef _dssbench dssbench
)sh";
constexpr const char* fish_script = R"sh(function __dssbench
  set -l words (commandline -opc)
  $words[1] complete $words[2..] (commandline -ct) 2>/dev/null
end
complete -c dssbench -a '(__dssbench)'
)sh";
const std::map<std::string, const char*> completion_scripts = {
    {"bash", bash_script}, {"zsh", zsh_script}, {"fish", fish_script}};

int print_completion(const std::string& shell) {
  const auto script = completion_scripts.find(shell);
  if (script == completion_scripts.end())
    throw InputError(fmt::format("completion {}: unknown shell; {}", shell,
                                 nearest_name(shell, names_of("SHELL"))));
  fmt::print("{}", script->second);
  return exit_success;
}

} // namespace

void add_completion_command(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand(
      "completion", "Print a script that completes this program's commands and options in a shell");
  const auto shell = std::make_shared<std::string>();
  command->add_option("SHELL", *shell, "bash, zsh or fish")->required();
  command->footer(
      "Example: dssbench completion bash > ~/.local/share/bash-completion/completions/dssbench\n"
      "         eval \"$(dssbench completion bash)\"       # for this shell alone");
  command->callback([shell, &chosen] { chosen = [shell] { return print_completion(*shell); }; });
}

} // namespace dss
