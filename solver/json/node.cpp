#include "solver/json/node.hpp"

#include "solver/nearest_name.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace dss {

double JsonFile::evaluate(const std::string& text) const {
  throw InputError(fmt::format("\"{}\" is not a number", text));
}

std::string listed(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string Node::shown() const {
  if (value_->is_structured())
    return fmt::format("an {} of {}", value_->is_object() ? "object" : "array", value_->size());
  std::string text = value_->dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return text.size() > 60 ? text.substr(0, 57) + "..." : text;
}

std::string Node::where() const {
  return fmt::format("{}: {}", file_->path, pointer_.empty() ? "/" : pointer_);
}

void Node::fail(const std::string& message) const {
  const std::string set_by = file_->changed_by(pointer_);
  std::string line = fmt::format("{}: {}", where(), message);
  if (!set_by.empty()) line += fmt::format(" (from {})", set_by);
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  throw InputError(line);
}

bool Node::is_number() const {
  return value_->is_number() ||
         (is_string() && file_->is_expression(value_->get_ref<const std::string&>(), pointer_));
}

double Node::number() const {
  if (!is_number())
    fail(fmt::format("{} is not a number; write {}", shown(), file_->number_forms()));
  if (value_->is_number()) return value_->get<double>();
  return placed([&] { return file_->evaluate(value_->get_ref<const std::string&>()); });
}

PlaceFunction Node::function_of_place() const {
  if (!is_string() || !is_number()) return {};
  PlaceFunction function = file_->function_of(value_->get_ref<const std::string&>());
  if (!function) return {};
  return [node = *this, function = std::move(function)](const Vec3& place) {
    return node.placed([&] { return function(place); });
  };
}

std::string Node::with_source(double value) const {
  return is_string() ? fmt::format("{} ({})", value, shown()) : fmt::format("{}", value);
}

double Node::positive() const {
  const double value = number();
  if (!(value > 0)) fail(with_source(value) + " is not positive");
  return value;
}

double Node::non_negative() const {
  const double value = number();
  if (!(value >= 0)) fail(with_source(value) + " is negative; it must be at least 0");
  return value;
}

long Node::whole(long least, long most) const {
  const double value = number();
  if (value != std::floor(value)) fail(with_source(value) + " is not a whole number");
  if (value < double(least) || value > double(most))
    fail(fmt::format("{} is out of range; it must be from {} to {}", with_source(value), least,
                     most));
  return long(value);
}

int Node::count(int least) const { return int(whole(least, std::numeric_limits<int>::max())); }

bool Node::flag() const {
  if (!value_->is_boolean()) fail(shown() + " is neither true nor false");
  return value_->get<bool>();
}

std::string Node::text() const {
  if (!is_string()) fail(shown() + " is not a text");
  return value_->get<std::string>();
}

std::string Node::name() const {
  if (text().empty()) fail("\"\" is no name; a name is not empty");
  return text();
}

Vec3 Node::vector() const {
  if (!is_array() || value_->size() != 3) fail(shown() + " is not [x, y, z]");
  const std::vector<Node> parts = items();
  return {parts[0].number(), parts[1].number(), parts[2].number()};
}

Vec3 Node::positive_vector() const {
  vector(); // checks the shape of the array
  const std::vector<Node> parts = items();
  return {parts[0].positive(), parts[1].positive(), parts[2].positive()};
}

std::vector<Node> Node::items(std::size_t least) const {
  if (!is_array()) fail(shown() + " is not an array [...]");
  if (value_->size() < least)
    fail(fmt::format("{}; give at least {}", value_->empty() ? "is empty" : shown() + " is short",
                     least == 1 ? "one" : fmt::format("{}", least)));
  std::vector<Node> nodes;
  for (std::size_t k = 0; k < value_->size(); ++k)
    nodes.push_back(Node(*file_, (*value_)[k], fmt::format("{}/{}", pointer_, k)));
  return nodes;
}

std::vector<Node> Node::list() const { return is_array() ? items(1) : std::vector<Node>{*this}; }

std::vector<std::string> Node::names() const {
  std::vector<std::string> all;
  for (const Node& item : list()) all.push_back(item.name());
  return all;
}

std::vector<double> Node::non_negatives() const {
  std::vector<double> all;
  for (const Node& item : list()) all.push_back(item.non_negative());
  return all;
}

std::vector<double> Node::positives() const {
  std::vector<double> all;
  for (const Node& item : list()) all.push_back(item.positive());
  return all;
}

std::vector<int> Node::counts(int least) const {
  std::vector<int> all;
  for (const Node& item : list()) all.push_back(item.count(least));
  return all;
}

std::size_t Node::choice(const char* what, const std::vector<std::string>& names) const {
  const std::string chosen = text();
  const auto place = std::find(names.begin(), names.end(), chosen);
  if (place == names.end())
    fail(fmt::format("unknown {} \"{}\"; {}", what, chosen, nearest_name(chosen, names)));
  return std::size_t(place - names.begin());
}

std::string Node::known_name(const char* what, const std::vector<std::string>& names) const {
  return names[choice(what, names)];
}

Node Node::member(const std::string& key, const nlohmann::json& value) const {
  return {*file_, value, pointer_ + (nlohmann::json::json_pointer() / key).to_string()};
}

} // namespace dss
