#include "experiments/runner/keyed_study.hpp"
#include "experiments/runner/study.hpp"
#include "solver/nearest_name.hpp"

namespace dss {

JsonPlace scale_of(const JsonPlace& root, const std::string& name) {
  const JsonPlace scales = root["scales"];
  if (scales.has(name)) return scales[name];
  std::vector<std::string> known;
  for (const auto& [key, value] : scales.value().items()) known.push_back(key);
  throw InputError(fmt::format("--scale {}: unknown scale; {}", name, nearest_name(name, known)));
}

std::optional<KeyedStudy> open_study(const std::string& study, const char* key, const std::string& scale) {
  const std::string path = study_path(study);
  const auto json = std::make_shared<const nlohmann::json>(parse_json_file(path));
  if (!json->is_object() || !json->contains(key)) return {};
  const JsonPlace root(*json, path);
  root.require_keys({"experiment", "title", key, "scales"});
  root.must_have({"experiment", "title", "scales"});
  return KeyedStudy{json, path, root["experiment"].text(), root["title"].text(), root[key], scale_of(root, scale)};
}

} // namespace dss
