/// Tables, and the numbers in them.
#include "experiments/base/records.hpp"
#include "fuzzed.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return dss::answered_for_file(data, size, ".csv", [](const std::string& path) {
    std::size_t complete = 0;
    const dss::Table table = dss::read_csv(path, &complete);
    for (const dss::Record& row : table.rows)
      for (const std::string& column : table.columns)
        dss::answered([&] { dss::number_in(row, column); });
  });
}
