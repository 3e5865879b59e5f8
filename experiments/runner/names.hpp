#pragma once
/// Names that the command line takes, by kind: the type that the help shows of an option (`--variant VARIANT`), or the
/// positional's own name (`SCENE`). tests/cli/completion_test.py holds them to what the commands accept.
#include <string>
#include <string_view>
#include <vector>

namespace dss {

/// All names of a kind, without opening any variant; empty for kinds that are free text, numbers or files.
std::vector<std::string> names_of(std::string_view kind);

} // namespace dss
