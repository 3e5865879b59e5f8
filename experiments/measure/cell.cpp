#include "experiments/measure/cell.hpp"

#include <fmt/format.h>

namespace dss {

std::string set_text(const std::vector<Override>& set) {
  std::string text;
  for (const Override& item : set)
    text += fmt::format("{}{}={}", text.empty() ? "" : " ", item.key, item.value);
  return text;
}

std::string Cell::set_text() const {
  if (members == 1) return dss::set_text(set);
  return fmt::format("ensemble={}{}{}", members, set.empty() ? "" : " ", dss::set_text(set));
}

std::string Cell::step_text() const {
  return (dt > 0 ? fmt::format(" dt {:.6g} s", dt) : "") +
         (rtol > 0 ? fmt::format(" rtol {:g}", rtol) : "");
}

std::string Cell::problem_key() const {
  return fmt::format("{} {} {} {} {}{} {} steps", scene, set_text(), model, precision, integrator,
                     step_text(), steps);
}

std::string Cell::key() const {
  // The key of a cell on 1 rank has no word about ranks, as in older records: the two stay
  // comparable.
  const std::string on_ranks =
      ranks == 1 ? "" : fmt::format("r{} {} {} ", ranks, decomposition, halo);
  return fmt::format("{} {} {}{}{} {}t{} {} {} {}{} {} steps{}", scene, set_text(), variant,
                     hybrid.empty() ? "" : "[" + hybrid + "]", device.empty() ? "" : "@" + device,
                     on_ranks, threads, model, precision, integrator, step_text(), steps,
                     is_twin ? " (A/A)" : "");
}

std::string Cell::label() const {
  const std::string team = fmt::format("{} thread{}", threads, threads == 1 ? "" : "s");
  const std::string twin = is_twin ? " (A/A)" : "";
  const std::string on_device = device.empty() ? "" : " on " + device;
  const std::string exchange =
      fmt::format(", halo {}{}", halo, decomposition == "strips" ? "" : ", " + decomposition);
  const std::string on_ranks = ranks == 1 ? "" : fmt::format(", {} ranks{}", ranks, exchange);
  if (!hybrid.empty() && hybrid != "auto")
    return fmt::format("hybrid {}{}{}", hybrid, on_ranks, twin);
  if (!hybrid.empty())
    return fmt::format("hybrid auto, {}{}{}", team, device.empty() ? "" : ", with " + device, twin);
  if (ranks == 1) return fmt::format("{}{}, {}{}", variant, on_device, team, twin);
  return fmt::format("{}, {} ranks x {}{}{}", variant, ranks, team, exchange, twin);
}

} // namespace dss
