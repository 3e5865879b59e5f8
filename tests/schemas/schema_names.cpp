/// Prints solver/json/names.schema.json: the names that the program lists, for the schemas of
/// scenes and studies. With a file, checks that it holds these names.
#include "experiments/measure/kernels/working_set.hpp"
#include "experiments/measure/study_names.hpp"
#include "experiments/run/plan/names.hpp"
#include "experiments/studies/failures/failure_case.hpp"
#include "solver/io/atomic_file.hpp"
#include "solver/numerics/method.hpp"
#include "solver/scene/selection.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace dss {
namespace {

std::string definition(const std::string& name, const std::vector<std::string>& values) {
  return fmt::format("    \"{}\": {{\n      \"enum\": [\"{}\"]\n    }}", name,
                     fmt::join(values, "\", \""));
}

/// Methods, and the one that takes a radius.
std::string method_definition() {
  return fmt::format(R"(    "method": {{
      "anyOf": [
        {{"enum": ["{}"]}},
        {{"type": "string", "pattern": "^{}(0(\\.[0-9]+)?|1(\\.0+)?)$"}}
      ]
    }})",
                     fmt::join(names_of("INTEGRATOR"), "\", \""), with_radius);
}

std::string names_schema() {
  const std::vector<std::string> definitions = {
      definition("analysis", names_of("ANALYSIS")),
      definition("decomposition", names_of("DECOMPOSITION")),
      definition("face", face_names),
      definition("field", {field_names.begin(), field_names.end()}),
      definition("halo", names_of("HALO")),
      definition("memory_level", memory_levels),
      method_definition(),
      definition("metric", atlas_metrics()),
      definition("model", model_names()),
      definition("precision", names_of("PRECISION")),
      definition("quantity", names_of("QUANTITY")),
      definition("rotation", names_of("ROTATION")),
      definition("verdict", {std::begin(atlas_verdicts), std::end(atlas_verdicts)})};
  return fmt::format(R"({{
  "$schema": "https://json-schema.org/draft/2020-12/schema",
  "title": "Names that dssbench knows",
  "description": "solver/json/README.md says how this file is written anew.",
  "$defs": {{
{}
  }}
}}
)",
                     fmt::join(definitions, ",\n"));
}

} // namespace
} // namespace dss

int main(int count, char** arguments) {
  const std::string right = dss::names_schema();
  if (count == 1) {
    fmt::print("{}", right);
    return 0;
  }
  if (dss::read_text(arguments[1]) == right) return 0;
  fmt::print(stderr, "{}: is not what the program lists; run make pages\n", arguments[1]);
  return 1;
}
