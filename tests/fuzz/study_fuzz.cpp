/// Studies, as far as their file tells.
#include "experiments/measure/study_file.hpp"
#include "experiments/studies/registry.hpp"
#include "fuzzed.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return dss::answered_for_file(data, size, ".json", [](const std::string& path) {
    const dss::StudyFile file = dss::open_study(path, "smoke");
    dss::ObjectNode root(file.root);
    for (const dss::StudyKind* kind : dss::study_kinds())
      if (root.has(kind->key)) dss::answered([&] { kind->read(file); });
  });
}
