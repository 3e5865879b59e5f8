#pragma once
/// Binaries of programs on disk, by the text of everything that they depend on.
#include <optional>
#include <string>
#include <string_view>

namespace dss::opencl {

/// $DSSBENCH_CACHE_DIR, else $XDG_CACHE_HOME/dssbench/opencl, else ~/.cache/dssbench/opencl; empty without any of them.
std::string cache_directory();
/// Whether $DSSBENCH_CACHE_DIR asks for binaries there, of every driver.
bool is_cache_asked_for();

/// The binary stored for `key`; nothing if there is none or it is damaged. No errors.
std::optional<std::string> load_binary(std::string_view key);

/// Stores it for later processes, where the directory can be written. No errors.
void store_binary(std::string_view key, std::string_view binary);

} // namespace dss::opencl
