#pragma once
/// Typed view of a scene's JSON. Each value knows its place, so every error says what is wrong,
/// where, and what would be right.
#include "kernels/fields.hpp"
#include "solver/scene/json/expression.hpp"

#include <nlohmann/json.hpp>

#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace dss {

/// Text of a scene: parsed, with overrides applied, and the parameters that its numbers use.
struct SceneText {
  std::string path; ///< as shown in errors
  nlohmann::json root;
  Parameters parameters; ///< resolved
  /// JSON pointer -> the --set that changed this value.
  std::map<std::string, std::string> overrides;
};

/// Returns "a, b, c" for the given names.
std::string listed(const std::vector<std::string>& names);

/// One value of a scene. Every read throws InputError "path: /json/pointer: what is wrong" if the
/// value is not as expected.
class Node {
public:
  Node(const SceneText& text, const nlohmann::json& value, std::string pointer)
      : text_(&text), value_(&value), pointer_(std::move(pointer)) {}

  double number() const; ///< finite; a JSON number or a text "=expression"
  double positive() const;
  double non_negative() const;
  long whole(long least, long most) const; ///< a number without a fraction, least <= number <= most
  std::string string() const;
  bool boolean() const;
  Vec3 vector() const; ///< [x, y, z]
  Vec3 positive_vector() const;
  std::vector<Node> items() const; ///< items of an array
  /// Index of a text among `names`. `what` is the kind of thing, for the error message.
  std::size_t choice(const char* what, const std::vector<std::string>& names) const;

  bool is_array() const { return value_->is_array(); }
  bool is_string() const { return value_->is_string(); }
  bool is_number() const; ///< true for a JSON number or an expression
  const nlohmann::json& json() const { return *value_; }
  const std::string& file() const { return text_->path; }
  const Parameters& parameters() const { return text_->parameters; }
  [[noreturn]] void fail(const std::string& message) const;

private:
  friend class ObjectNode;
  bool is_expression() const;                  ///< a text "=..."; a text from --set needs no "="
  std::string with_source(double value) const; ///< the number and its expression, for errors
  const SceneText* text_;
  const nlohmann::json* value_;
  std::string pointer_;
};

/// An object of a scene. Every key that is read counts as known. finish() refuses the others.
class ObjectNode {
public:
  explicit ObjectNode(const Node& node);

  Node require(const std::string& key);
  std::optional<Node> find(const std::string& key);
  double number_or(const std::string& key, double otherwise);
  double non_negative_or(const std::string& key, double otherwise);
  double positive_or(const std::string& key, double otherwise);
  Vec3 vector_or(const std::string& key, const Vec3& otherwise);
  /// The one of these keys that is present. None or several are an error.
  std::string require_one(const std::vector<std::string>& keys);
  /// Refuses keys that were not read, and names the nearest known key.
  void finish() const;
  [[noreturn]] void fail(const std::string& message) const { node_.fail(message); }
  const Node& node() const { return node_; }

private:
  std::string listed_keys() const; ///< keys of the object; one may be a misspelt key
  Node node_;
  std::set<std::string> known_;
};

} // namespace dss
