/// Checkpoints. Digests would stop nearly all inputs. So one that begins with a line of JSON is
/// written as a file of blocks whose digests are right: that line, then its other bytes.
#include "experiments/run/checkpoint/checkpoint.hpp"
#include "fuzzed.hpp"
#include "solver/io/kept_numbers.hpp"
#include "solver/numerics/step_control.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>

namespace {

constexpr std::size_t block = 3; // numbers

void write_blocks(const std::string& path, std::string_view text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const auto head = nlohmann::ordered_json::parse(text.substr(0, end), nullptr, false);
  if (!head.is_object()) return;
  const std::string_view rest = text.substr(std::min(end + 1, text.size()));
  std::vector<double> numbers(rest.size() / sizeof(double));
  if (!numbers.empty()) std::memcpy(numbers.data(), rest.data(), numbers.size() * sizeof(double));
  dss::BlockWriter writer(path, head);
  for (std::size_t first = 0; first < numbers.size(); first += block)
    writer.write(std::span(numbers).subspan(first, std::min(block, numbers.size() - first)));
  writer.commit();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  return dss::answered_for_file(data, size, ".ckpt", [&](const std::string& path) {
    write_blocks(path, text);
    const dss::SavedRun saved(path);
    dss::StepControl control({1e-3, 0}, 1, 1);
    dss::TakeNumbers take(saved.standing().steps_kept);
    control.each_kept(take);
  });
}
