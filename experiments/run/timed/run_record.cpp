#include "experiments/run/timed/run_record.hpp"
#include "experiments/run/plan/context.hpp"
#include "experiments/run/timed/run_fields.hpp"

namespace dss {
nlohmann::ordered_json record_of(const std::string& scene, const std::vector<Override>& overrides) {
  nlohmann::ordered_json json;
  json["context"] = measurement_context();
  json["scene"] = scene;
  json["set"] = nlohmann::ordered_json::object();
  for (const Override& item : overrides) json["set"][item.key] = item.value;
  return json;
}

nlohmann::ordered_json run_json(const RunResult& result) {
  nlohmann::ordered_json json;
  for (const RunField& field : run_fields()) json[field.key] = field.value(result);
  return json;
}

nlohmann::ordered_json run_json(const RunRequest& request, const RunResult& result) {
  nlohmann::ordered_json json = record_of(result.scene, request.overrides);
  json.update(run_json(result));
  return json;
}

} // namespace dss
