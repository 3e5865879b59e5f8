/// Expressions of scenes, with the parameters n and k.
#include "fuzzed.hpp"
#include "solver/scene/expression.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return dss::answered([&] { dss::evaluate(dss::text_of(data, size), {{"n", 4}, {"k", 1e9}}); });
}
