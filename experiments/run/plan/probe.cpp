#include "experiments/run/plan/probe.hpp"

#include "solver/error.hpp"
#include "solver/model/element_place.hpp"
#include "solver/nearest_name.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <string_view>

namespace dss {
namespace {

/// What --probe says, unchecked against the scene.
struct ProbeText {
  std::string name, body;
  Vec3 place{};
};

bool is_of_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-';
}

ProbeText parsed(const std::string& text) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(
        fmt::format("--probe {}: {}; give NAME=BODY,x,y,z, the place in m at rest", text, what));
  };
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) refuse("has no \"=\"");
  ProbeText probe{text.substr(0, equals), {}, {}};
  if (probe.name.empty() || !std::ranges::all_of(probe.name, is_of_name))
    refuse("the name must have letters, digits, _ and - alone");
  std::size_t end = text.size(); // from the back: a body's name may have commas
  for (std::size_t a = 3; a-- > 0;) {
    const std::size_t comma = text.rfind(',', end - 1);
    if (comma == std::string::npos || comma <= equals) refuse("has not three coordinates");
    const char *first = text.data() + comma + 1, *last = text.data() + end;
    const auto [stop, error] = std::from_chars(first, last, probe.place[a]);
    if (error != std::errc{} || stop != last || !std::isfinite(probe.place[a]))
      refuse(fmt::format("\"{}\" is no number", std::string_view(first, last)));
    end = comma;
  }
  probe.body = text.substr(equals + 1, end - equals - 1);
  return probe;
}

} // namespace

Probe read_probe(const std::string& text, const Problem& problem) {
  const ProbeText asked = parsed(text);
  std::vector<std::string> names;
  for (const Body& body : problem.bodies) names.push_back(body.name);
  const auto found = std::ranges::find(names, asked.body);
  if (found == names.end())
    throw InputError(fmt::format("--probe {}: the scene has no body \"{}\"; {}", text, asked.body,
                                 nearest_name(asked.body, names)));
  const int body = int(found - names.begin());
  const NearestPlace at = nearest_place(problem, body, asked.place);
  const Vec3& edge = problem.bodies[std::size_t(body)].edge;
  if (at.distance > *std::ranges::max_element(edge))
    throw InputError(fmt::format("--probe {}: the place is {:.3g} m outside of the body, more than "
                                 "an element; the nearest element is at ({:.6g}) m",
                                 text, at.distance, fmt::join(at.centre, ", ")));
  Probe probe{asked.name, at.element, {}, at.arm, {}};
  for (std::size_t a = 0; a < 3; ++a) probe.place[a] = at.arm[a] / (edge[a] / 2);
  probe.text =
      fmt::format("probe {}: in element [{}] of body \"{}\", whose centre is ({:.6g}) m at "
                  "rest",
                  asked.name, fmt::join(at.cell, ", "), asked.body, fmt::join(at.centre, ", "));
  if (at.distance > 1e-9 * shortest_edge(problem))
    probe.text += fmt::format("; the place given is {:.3g} m outside of the body", at.distance);
  return probe;
}

std::vector<Probe> read_probes(const std::vector<std::string>& texts, const Problem& problem) {
  std::vector<Probe> probes;
  for (const std::string& text : texts) {
    Probe probe = read_probe(text, problem);
    if (std::ranges::find(probes, probe.name, &Probe::name) != probes.end())
      throw InputError(fmt::format(
          "--probe {}: there is a probe \"{}\" before it; give another name", text, probe.name));
    probes.push_back(std::move(probe));
  }
  return probes;
}

} // namespace dss
