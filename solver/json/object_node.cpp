#include "solver/json/object_node.hpp"

#include "solver/nearest_name.hpp"

#include <fmt/format.h>

namespace dss {
namespace {

/// Reads a key by one of Node's functions, or returns `otherwise`.
template <class Value>
Value read_or(ObjectNode& object, const std::string& key, Value otherwise,
              Value (Node::*read)() const) {
  const std::optional<Node> node = object.find(key);
  return node ? ((*node).*read)() : otherwise;
}

} // namespace

ObjectNode::ObjectNode(const Node& node) : node_(node) {
  if (!node.is_object()) node.fail(node.shown() + " is not an object {...}");
}

std::optional<Node> ObjectNode::find(const std::string& key) {
  known_.insert(key);
  const auto place = node_.json().find(key);
  if (place == node_.json().end()) return std::nullopt;
  return node_.member(key, *place);
}

Node ObjectNode::require(const std::string& key) {
  must_have({key});
  return *find(key);
}

std::vector<std::pair<std::string, Node>> ObjectNode::members() {
  std::vector<std::pair<std::string, Node>> all;
  for (const auto& item : node_.json().items()) all.emplace_back(item.key(), require(item.key()));
  return all;
}

double ObjectNode::number_or(const std::string& key, double otherwise) {
  return read_or(*this, key, otherwise, &Node::number);
}

double ObjectNode::positive_or(const std::string& key, double otherwise) {
  return read_or(*this, key, otherwise, &Node::positive);
}

double ObjectNode::non_negative_or(const std::string& key, double otherwise) {
  return read_or(*this, key, otherwise, &Node::non_negative);
}

long ObjectNode::whole_or(const std::string& key, long least, long otherwise) {
  const std::optional<Node> node = find(key);
  return node ? node->whole(least) : otherwise;
}

bool ObjectNode::flag_or(const std::string& key, bool otherwise) {
  return read_or(*this, key, otherwise, &Node::flag);
}

Vec3 ObjectNode::vector_or(const std::string& key, const Vec3& otherwise) {
  return read_or(*this, key, otherwise, &Node::vector);
}

std::string ObjectNode::name_or(const std::string& key, const std::string& otherwise) {
  return read_or(*this, key, otherwise, &Node::name);
}

std::vector<std::string> ObjectNode::names_or(const std::string& key,
                                              const std::vector<std::string>& otherwise) {
  return read_or(*this, key, otherwise, &Node::names);
}

std::vector<std::string> ObjectNode::known_names_or(const std::string& key, const char* what,
                                                    const std::vector<std::string>& known,
                                                    const std::vector<std::string>& otherwise) {
  const std::optional<Node> node = find(key);
  if (!node) return otherwise;
  std::vector<std::string> names;
  for (const Node& item : node->list()) names.push_back(item.known_name(what, known));
  return names;
}

void ObjectNode::must_have(const std::vector<std::string>& keys) {
  std::vector<std::string> missing;
  for (const std::string& key : keys)
    if (!has(key)) missing.push_back('"' + key + '"');
  if (!missing.empty())
    fail(fmt::format("lacks the key{} {}; {}", missing.size() == 1 ? "" : "s", listed(missing),
                     listed_keys()));
}

std::string ObjectNode::require_one(const std::vector<std::string>& keys) {
  std::vector<std::string> there;
  for (const std::string& key : keys)
    if (has(key)) there.push_back(key);
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
  for (const auto& item : node_.json().items())
    if (!known_.contains(item.key()))
      node_.member(item.key(), item.value())
          .fail("unknown key; " + nearest_name(item.key(), known));
}

} // namespace dss
