#pragma once
/// Probes: places in bodies whose motion and stress a run follows.
#include "solver/model/problem.hpp"

#include <string>
#include <vector>

namespace dss {

/// A place in an element, at rest.
struct Probe {
  std::string name;
  std::size_t element = 0;
  Vec3 place{};     ///< in the element, from -1 to 1 along its axes
  Vec3 arm{};       ///< from its centre [m]
  std::string text; ///< where it is, for the user
};

/// Reads a value of --probe, "NAME=BODY,x,y,z", with the place [m] at rest. The probe is at the
/// nearest place in an element of the body; of elements equally near, the first.
/// @throws InputError if it is none: one line with the value and what would be right
Probe read_probe(const std::string& text, const Problem& problem);

/// @throws InputError as read_probe; if two have one name
std::vector<Probe> read_probes(const std::vector<std::string>& texts, const Problem& problem);

} // namespace dss
