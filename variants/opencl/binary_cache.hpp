#pragma once
/// Binaries of programs on disk. The key is the text of everything that a binary depends on.
#include <optional>
#include <string>
#include <string_view>

namespace dss::opencl {

/// The directory of binaries: $DSSBENCH_CACHE_DIR, else $XDG_CACHE_HOME/dssbench/opencl, else
/// ~/.cache/dssbench/opencl; empty if no such variable is set.
std::string cache_directory();
/// Whether $DSSBENCH_CACHE_DIR is set. Then binaries of every driver are kept there.
bool is_cache_asked_for();

/// @return the binary stored for `key`; nothing if there is none or it is damaged. Never throws.
std::optional<std::string> load_binary(std::string_view key);

/// Stores a binary for later processes, if the directory can be written. Never throws.
void store_binary(std::string_view key, std::string_view binary);

} // namespace dss::opencl
