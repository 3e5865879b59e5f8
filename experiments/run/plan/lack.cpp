#include "experiments/run/plan/lack.hpp"

#include <fmt/format.h>

namespace dss {

std::optional<Lack> what_lacks(const Plugin& plugin, const Problem& problem, Precision precision,
                               const Method& method, Rotation rotation) {
  const std::string other = plugin.solves_equations() ? "another --variant" : "--variant reference";
  if (const char* const missing = missing_term(plugin, problem))
    return Lack{problem.name, missing, other};
  if (precision == Precision::f32c && !plugin.is_compensated)
    return Lack{"--precision f32c", "has f64 and f32 alone", other};
  if (plugin.rotation != Rotation::quaternion && rotation != plugin.rotation)
    return Lack{fmt::format("--rotation {}", name(rotation)),
                fmt::format("has {} alone", name(plugin.rotation)), other};
  if (plugin.has_all) return {};
  if (plugin.is_implicit && precision != Precision::f64)
    return Lack{fmt::format("--precision {}", name(precision)), "has f64 alone", other};
  if (plugin.is_implicit && !method.is_implicit())
    return Lack{fmt::format("--integrator {}", method.name), "has the implicit methods alone",
                "--integrator newmark"};
  if (method.is_implicit() && !plugin.is_implicit)
    return Lack{fmt::format("--integrator {}", method.name), "has the explicit methods alone",
                "--variant reference or sparse"};
  if (rotation != Rotation::quaternion)
    return Lack{fmt::format("--rotation {}", name(rotation)), "has quaternions alone", other};
  return {};
}

} // namespace dss
