#include "experiments/measure/json_place.hpp"
#include "solver/io/atomic_file.hpp"
#include "solver/nearest_name.hpp"

#include <algorithm>
#include <fmt/ranges.h>

namespace dss {

void JsonPlace::require_keys(const std::vector<std::string>& allowed) const {
  if (!value_.is_object()) fail("is not an object");
  for (const auto& [key, value] : value_.items())
    if (std::ranges::find(allowed, key) == allowed.end())
      fail(fmt::format("unknown key \"{}\"; {}", key, nearest_name(key, allowed)));
}

void JsonPlace::must_have(const std::vector<std::string>& keys) const {
  std::vector<std::string> missing;
  for (const std::string& key : keys)
    if (!has(key)) missing.push_back(fmt::format("\"{}\"", key));
  if (!missing.empty())
    fail(fmt::format("lacks the key{} {}", missing.size() == 1 ? "" : "s",
                     fmt::join(missing, ", ")));
}

JsonPlace JsonPlace::operator[](const std::string& key) const {
  must_have({key});
  return {value_.at(key), file_, pointer_ + "/" + key};
}

std::vector<JsonPlace> JsonPlace::items() const {
  if (!value_.is_array()) return {*this};
  std::vector<JsonPlace> places;
  for (std::size_t i = 0; i < value_.size(); ++i)
    places.emplace_back(value_[i], file_, fmt::format("{}/{}", pointer_, i));
  return places;
}

std::string JsonPlace::text() const {
  if (!value_.is_string() || value_.get<std::string>().empty())
    fail(fmt::format("{} is not a name", value_.dump()));
  return value_.get<std::string>();
}

std::vector<std::string> JsonPlace::texts() const {
  std::vector<std::string> all;
  for (const JsonPlace& item : items()) all.push_back(item.text());
  if (all.empty()) fail("is empty; give at least one name");
  return all;
}

bool JsonPlace::flag() const {
  if (!value_.is_boolean()) fail(fmt::format("{} is neither true nor false", value_.dump()));
  return value_.get<bool>();
}

double JsonPlace::positive() const {
  if (!value_.is_number() || !(value_.get<double>() > 0))
    fail(fmt::format("{} is not a positive number", value_.dump()));
  return value_.get<double>();
}

long JsonPlace::count(long least) const {
  if (!value_.is_number_integer() || value_.get<long>() < least)
    fail(fmt::format("{} is not a whole number of at least {}", value_.dump(), least));
  return value_.get<long>();
}

std::vector<int> JsonPlace::whole_numbers() const {
  std::vector<int> all;
  for (const JsonPlace& item : items()) {
    if (!item.value().is_number_integer())
      item.fail(fmt::format("{} is not a whole number", item.value().dump()));
    all.push_back(item.value().get<int>());
  }
  if (all.empty()) fail("is empty; give at least one whole number");
  return all;
}

nlohmann::json parse_json_file(const std::string& path) {
  const std::string text = read_text(path);
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    const std::size_t place =
        std::min<std::size_t>(error.byte > 0 ? error.byte - 1 : 0, text.size());
    const auto line = 1 + std::count(text.begin(), text.begin() + std::ptrdiff_t(place), '\n');
    const std::size_t line_start = text.rfind('\n', place > 0 ? place - 1 : 0);
    const std::size_t column =
        line_start == std::string::npos || place == 0 ? place + 1 : place - line_start;
    throw InputError(fmt::format("{}: line {}, column {}: broken JSON; a value, a comma or a "
                                 "bracket is missing or too much here",
                                 path, line, column));
  }
}

} // namespace dss
