/// Command lines, a word a line. No command runs.
#include "experiments/cli/command_line.hpp"
#include "fuzzed.hpp"

#include <sstream>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::istringstream text(dss::text_of(data, size));
  std::vector<std::string> words;
  for (std::string word; std::getline(text, word);) words.push_back(word);
  return dss::answered([&] {
    try {
      dss::CommandLine().parse(words);
    } catch (const CLI::Success&) { // help or the version
    }
  });
}
