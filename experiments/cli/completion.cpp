#include "experiments/cli/completion.hpp"

#include "experiments/cli/commands.hpp"
#include "experiments/measure/study_file.hpp"
#include "experiments/run/plan/names.hpp"
#include "solver/scene/scene.hpp"

#include <algorithm>

namespace dss {
namespace {

using Words = std::vector<std::string>;

/// The words before the one to be completed.
struct TypedLine {
  const CLI::App* command; ///< the program itself before a command is typed
  Words positionals;
  Words before;
};

const CLI::Option* find_option(const CLI::App* command, const std::string& word) {
  for (; command != nullptr; command = command->get_parent())
    if (const CLI::Option* option = command->get_option_no_throw(word.substr(0, word.find('=')));
        option != nullptr && !option->get_positional())
      return option;
  return nullptr;
}

bool takes_next(const CLI::Option* option, const std::string& word) {
  return option != nullptr && option->get_items_expected_max() > 0 &&
         word.find('=') == std::string::npos;
}

TypedLine read_line(const CLI::App& app, const Words& before) {
  TypedLine line{&app, {}, before};
  for (std::size_t place = 0; place < before.size(); ++place) {
    const std::string& word = before[place];
    if (word.starts_with("-")) {
      if (!takes_next(find_option(line.command, word), word)) continue;
      ++place;
    } else if (line.command == &app) {
      const CLI::App* command = find_command(app, word);
      if (command == nullptr) return {nullptr, {}, before};
      line.command = command;
    } else {
      line.positionals.push_back(word);
    }
  }
  return line;
}

/// Parameters of the scene on the line: "n=".
Words parameters_of(const TypedLine& line) {
  Words keys;
  for (const SceneListing& scene : list_scenes())
    if (std::ranges::find(line.before, scene.name) != line.before.end())
      for (const auto& [key, value] : scene.parameters) keys.push_back(key + "=");
  return keys;
}

/// Scales of the study on the line; without a study, the usual scales.
Words scales_of(const TypedLine& line) {
  const Words scales = line.positionals.empty() ? Words{} : scale_names(line.positionals.front());
  return scales.empty() ? names_of("SCALE") : scales;
}

Words values_of(const CLI::Option& option, const TypedLine& line) {
  const std::string kind = option.get_positional() ? option.get_name(true) : option.get_type_name();
  if (kind == "KEY=VALUE") return parameters_of(line);
  if (kind == "SCALE") return scales_of(line);
  if (kind == "EXPERIMENT") {
    Words studies;
    for (const StudyListing& study : list_studies()) studies.push_back(study.name);
    return studies;
  }
  if (kind != "COMMAND") return names_of(kind);
  return command_names(*line.command->get_parent());
}

Words options_of(const CLI::App* command) {
  Words names;
  for (; command != nullptr; command = command->get_parent())
    for (const CLI::Option* option : command->get_options())
      for (const std::string& name : option->get_lnames())
        if (!option->get_group().empty() && std::ranges::find(names, "--" + name) == names.end())
          names.push_back("--" + name);
  return names;
}

const CLI::Option* positional_of(const TypedLine& line) {
  std::size_t place = 0;
  for (const CLI::Option* option : line.command->get_options())
    if (option->get_positional() &&
        (place++ == line.positionals.size() || option->get_items_expected_max() > 1))
      return option;
  return nullptr;
}

/// The names that begin like the word. In a list, only the part after the last comma is completed,
/// and the rest is repeated before each name.
Words beginning_with(const std::string& word, const Words& names, const std::string& prefix,
                     bool is_list) {
  const std::size_t comma = is_list ? word.rfind(',') : std::string::npos;
  const std::size_t begin = comma == std::string::npos ? 0 : comma + 1;
  Words found;
  for (const std::string& name : names)
    if (name.starts_with(word.substr(begin)))
      found.push_back(prefix + word.substr(0, begin) + name);
  return found;
}

} // namespace

std::vector<std::string> completions(const CLI::App& app, std::vector<std::string> words) {
  std::string word = words.empty() ? "" : words.back();
  if (!words.empty()) words.pop_back();
  if (word == "=") word.clear();
  std::erase(words, "=");
  const TypedLine line = read_line(app, words);
  if (line.command == nullptr) return {};
  const auto values = [&](const CLI::Option& option, const std::string& value,
                          const std::string& prefix) {
    return beginning_with(value, values_of(option, line), prefix, option.get_delimiter() != '\0');
  };
  if (!words.empty() && words.back().starts_with("-"))
    if (const CLI::Option* option = find_option(line.command, words.back());
        takes_next(option, words.back()))
      return values(*option, word, "");
  if (word.starts_with("-")) {
    const std::size_t sign = word.find('=');
    if (sign == std::string::npos) return beginning_with(word, options_of(line.command), "", false);
    const CLI::Option* option = find_option(line.command, word);
    return option == nullptr ? Words{}
                             : values(*option, word.substr(sign + 1), word.substr(0, sign + 1));
  }
  if (line.command == &app) return beginning_with(word, command_names(app), "", false);
  const CLI::Option* positional = positional_of(line);
  return positional == nullptr ? Words{} : values(*positional, word, "");
}

} // namespace dss
