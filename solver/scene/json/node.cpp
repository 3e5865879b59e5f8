#include "solver/scene/json/node.hpp"

#include "solver/error.hpp"
#include "solver/nearest_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace dss {
namespace {

/// The value as text, short enough for one line.
std::string shown(const nlohmann::json& value) {
  if (value.is_object() || value.is_array())
    return fmt::format("an {} of {}", value.is_object() ? "object" : "array", value.size());
  std::string text = value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return text.size() > 60 ? text.substr(0, 57) + "..." : text;
}

/// A key as written in a JSON pointer (RFC 6901).
std::string escaped(const std::string& key) {
  std::string text;
  for (const char c : key) text += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return text;
}

} // namespace

std::string listed(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

void Node::fail(const std::string& message) const {
  const auto set_by = text_->overrides.find(pointer_);
  std::string line =
      fmt::format("{}: {}: {}", text_->path, pointer_.empty() ? "/" : pointer_, message);
  if (set_by != text_->overrides.end()) line += fmt::format(" (from {})", set_by->second);
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  throw InputError(line);
}

bool Node::is_expression() const {
  return value_->is_string() && (value_->get_ref<const std::string&>().starts_with('=') ||
                                 text_->overrides.contains(pointer_));
}
bool Node::is_number() const { return value_->is_number() || is_expression(); }

double Node::number() const {
  if (!is_number())
    fail(fmt::format("{} is not a number; write a number or \"=expression\"", shown(*value_)));
  if (value_->is_number()) return value_->get<double>();
  const auto& expression = value_->get_ref<const std::string&>();
  try {
    return evaluate(expression.substr(expression.starts_with('=') ? 1 : 0), text_->parameters);
  } catch (const InputError& error) {
    const auto& names = text_->parameters;
    std::vector<std::string> known;
    for (const auto& item : names) known.push_back(item.first);
    fail(
        fmt::format("{}; parameters are {}", error.what(), known.empty() ? "none" : listed(known)));
  }
}

std::string Node::with_source(double value) const {
  return is_string() ? fmt::format("{} ({})", value, shown(*value_)) : fmt::format("{}", value);
}

double Node::positive() const {
  const double value = number();
  if (!(value > 0)) fail(with_source(value) + " is not positive");
  return value;
}

double Node::non_negative() const {
  const double value = number();
  if (!(value >= 0)) fail(with_source(value) + " is negative");
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

std::string Node::string() const {
  if (!value_->is_string()) fail(fmt::format("{} is not a text", shown(*value_)));
  return value_->get<std::string>();
}

bool Node::boolean() const {
  if (!value_->is_boolean()) fail(fmt::format("{} is neither true nor false", shown(*value_)));
  return value_->get<bool>();
}

Vec3 Node::vector() const {
  if (!value_->is_array() || value_->size() != 3)
    fail(fmt::format("{} is not [x, y, z]", shown(*value_)));
  const std::vector<Node> parts = items();
  return {parts[0].number(), parts[1].number(), parts[2].number()};
}

Vec3 Node::positive_vector() const {
  vector(); // checks the shape of the array
  const std::vector<Node> parts = items();
  return {parts[0].positive(), parts[1].positive(), parts[2].positive()};
}

std::vector<Node> Node::items() const {
  if (!value_->is_array()) fail(fmt::format("{} is not an array [...]", shown(*value_)));
  std::vector<Node> nodes;
  for (std::size_t k = 0; k < value_->size(); ++k)
    nodes.emplace_back(*text_, (*value_)[k], fmt::format("{}/{}", pointer_, k));
  return nodes;
}

std::size_t Node::choice(const char* what, const std::vector<std::string>& names) const {
  const std::string text = string();
  const auto place = std::find(names.begin(), names.end(), text);
  if (place == names.end())
    fail(fmt::format("\"{}\" is not a known {}; known are {}", text, what, listed(names)));
  return std::size_t(place - names.begin());
}

ObjectNode::ObjectNode(const Node& node) : node_(node) {
  if (!node.json().is_object())
    node.fail(fmt::format("{} is not an object {{...}}", shown(node.json())));
}

std::optional<Node> ObjectNode::find(const std::string& key) {
  known_.insert(key);
  const auto place = node_.json().find(key);
  if (place == node_.json().end()) return std::nullopt;
  return Node(*node_.text_, *place, node_.pointer_ + "/" + escaped(key));
}

Node ObjectNode::require(const std::string& key) {
  const std::optional<Node> node = find(key);
  if (!node) fail(fmt::format("\"{}\" is missing; {}", key, listed_keys()));
  return *node;
}

double ObjectNode::number_or(const std::string& key, double otherwise) {
  const std::optional<Node> node = find(key);
  return node ? node->number() : otherwise;
}

double ObjectNode::positive_or(const std::string& key, double otherwise) {
  const std::optional<Node> node = find(key);
  return node ? node->positive() : otherwise;
}

double ObjectNode::non_negative_or(const std::string& key, double otherwise) {
  const std::optional<Node> node = find(key);
  return node ? node->non_negative() : otherwise;
}

Vec3 ObjectNode::vector_or(const std::string& key, const Vec3& otherwise) {
  const std::optional<Node> node = find(key);
  return node ? node->vector() : otherwise;
}

std::string ObjectNode::require_one(const std::vector<std::string>& keys) {
  std::vector<std::string> there;
  for (const std::string& key : keys)
    if (find(key)) there.push_back(key);
  if (there.empty()) fail(fmt::format("one of {} is missing; {}", listed(keys), listed_keys()));
  if (there.size() > 1) fail(fmt::format("{} exclude each other; give one of them", listed(there)));
  return there.front();
}

std::string ObjectNode::listed_keys() const {
  std::vector<std::string> there;
  for (const auto& item : node_.json().items()) there.push_back(item.key());
  return "there are: " + (there.empty() ? "no keys" : listed(there));
}

void ObjectNode::finish() const {
  const std::vector<std::string> known(known_.begin(), known_.end());
  for (const auto& item : node_.json().items()) {
    if (known_.contains(item.key())) continue;
    Node(*node_.text_, item.value(), node_.pointer_ + "/" + escaped(item.key()))
        .fail("unknown key; " + nearest_name(item.key(), known));
  }
}

} // namespace dss
