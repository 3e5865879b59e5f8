#pragma once
/// What a variant does not have but a run needs.
#include "variants/loading/loader.hpp"

#include <optional>
#include <string>

namespace dss {

/// A feature that a variant does not have but the run needs.
struct Lack {
  std::string asked_by; ///< "--rotation tait_bryan", or the name of the scene
  std::string what;     ///< what the variant has instead: "has quaternions alone"
  std::string remedy;   ///< "--variant reference"
};
/// Finds the first feature that `plugin` does not have; empty if it has all.
std::optional<Lack> what_lacks(const Plugin& plugin, const Problem& problem, Precision precision,
                               const Method& method, Rotation rotation);

} // namespace dss
