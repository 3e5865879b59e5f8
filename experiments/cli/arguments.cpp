#include "experiments/cli/arguments.hpp"
#include "solver/error.hpp"

#include <cstdio>
#include <fmt/format.h>

namespace dss {

std::vector<Override> parse_overrides(const std::vector<std::string>& texts) {
  std::vector<Override> overrides;
  for (const std::string& text : texts) {
    const auto sign = text.find('=');
    if (sign == std::string::npos || sign == 0 || sign + 1 == text.size())
      throw InputError(
          fmt::format("--set {}: is not KEY=VALUE, such as n=50 or run.dt=1e-7", text));
    overrides.push_back({text.substr(0, sign), text.substr(sign + 1)});
  }
  return overrides;
}

std::vector<std::string>& words_after_mark() {
  static std::vector<std::string> words;
  return words;
}

void write_json(const std::string& target, const nlohmann::ordered_json& json) {
  FileSet alone;
  write_json(alone, target, json);
}

void write_json(FileSet& outputs, const std::string& target, const nlohmann::ordered_json& json) {
  const std::string text = json.dump(2) + "\n";
  if (!target.empty() && target != "-") outputs.open(target).write(text);
  outputs.commit();
  if (target == "-") fmt::print("{}", text);
}

} // namespace dss
