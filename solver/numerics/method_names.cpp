/// Methods by their names.
#include "solver/nearest_name.hpp"
#include "solver/numerics/method.hpp"

#include <charconv>
#include <fmt/format.h>
#include <map>
#include <mutex>
#include <optional>

namespace dss {
namespace {

/// The radius of a name that ends with it; nothing if it is no number from 0 to 1.
std::optional<double> radius_of(std::string_view name) {
  const std::string_view text = name.substr(with_radius.size());
  if (text.empty() || text.find_first_not_of("0123456789.") != text.npos || text.front() == '.' ||
      text.back() == '.')
    return {};
  double radius = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), radius);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  if (!is_number || !(radius >= 0 && radius <= 1)) return {};
  return radius;
}

/// The method of a name with a radius, which keeps that name.
const Method* method_with_radius(std::string_view name) {
  const std::optional<double> radius = radius_of(name);
  if (!radius) return nullptr;
  static std::mutex mutex;
  static std::map<std::string, Method, std::less<>> known;
  const std::lock_guard lock(mutex);
  const auto [place, is_new] = known.try_emplace(std::string(name), generalized_alpha(*radius));
  if (is_new) place->second.name = place->first;
  return &place->second;
}

} // namespace

std::vector<const Method*> all_methods() {
  std::vector<const Method*> all;
  for (const auto* kind : {&methods(), &implicit_methods()})
    for (const Method& method : *kind) all.push_back(&method);
  return all;
}

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const Method* method : all_methods()) names.emplace_back(method->name);
  for (const Method& method : exponential_methods()) names.emplace_back(method.name);
  return names;
}

const Method* find_method(std::string_view name) {
  if (name.starts_with(with_radius)) return method_with_radius(name);
  for (const Method* method : all_methods())
    if (method->name == name) return method;
  for (const Method& method : exponential_methods())
    if (method.name == name) return &method;
  return nullptr;
}

std::string why_no_method(std::string_view name) {
  if (find_method(name) != nullptr) return "";
  if (name.starts_with(with_radius))
    return fmt::format("the radius after \"{}\" must be a number from 0 to 1", with_radius);
  return fmt::format("unknown integrator; {}", nearest_name(std::string(name), method_names()));
}

} // namespace dss
