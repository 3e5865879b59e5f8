#pragma once
/// Names that the command line accepts, by kind. The kind of an option is the type in its help text
/// (`--variant VARIANT`). The kind of a positional argument is its own name (`SCENE`).
/// tests/cli/completion_test.py checks that the commands accept these names.
#include <string>
#include <string_view>
#include <vector>

namespace dss {

/// All names of a kind. Opens no variant. Empty if the kind is free text, a number or a file.
std::vector<std::string> names_of(std::string_view kind);

} // namespace dss
