#pragma once
/// A typed view of a scene's JSON that knows where it stands, so that every error says what, where and what would be
/// right.
#include "solver/model/fields.hpp"
#include "solver/scene/json/expression.hpp"

#include <nlohmann/json.hpp>

#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace dss {

/// A scene's text, parsed, with overrides applied, and what its numbers refer to.
struct SceneText {
  std::string path; ///< as it is shown in errors
  nlohmann::json root;
  Parameters parameters;                        ///< resolved
  std::map<std::string, std::string> overrides; ///< JSON pointer -> the --set that changed what stands there
};

/// "a, b, c" of the given names.
std::string listed(const std::vector<std::string>& names);

/// One value of a scene. Every read throws InputError "path: /json/pointer: what is wrong" for anything unexpected.
class Node {
public:
  Node(const SceneText& text, const nlohmann::json& value, std::string pointer)
      : text_(&text), value_(&value), pointer_(std::move(pointer)) {}

  double number() const; ///< finite; a JSON number or a text "=expression"
  double positive() const;
  double non_negative() const;
  long whole(long least, long most) const; ///< a number without a fraction in least .. most
  std::string string() const;
  bool boolean() const;
  Vec3 vector() const; ///< [x, y, z]
  Vec3 positive_vector() const;
  std::vector<Node> items() const; ///< of an array
  /// The place of a text among names; `what` names the kind of thing in the error.
  std::size_t choice(const char* what, const std::vector<std::string>& names) const;

  bool is_array() const { return value_->is_array(); }
  bool is_string() const { return value_->is_string(); }
  bool is_number() const; ///< a JSON number or an expression
  const nlohmann::json& json() const { return *value_; }
  const std::string& file() const { return text_->path; }
  const Parameters& parameters() const { return text_->parameters; }
  [[noreturn]] void fail(const std::string& message) const;

private:
  friend class ObjectNode;
  bool is_expression() const;                  ///< a text "=..."; from --set also without "="
  std::string with_source(double value) const; ///< and the expression that gave it
  const SceneText* text_;
  const nlohmann::json* value_;
  std::string pointer_;
};

/// An object of a scene. Every key asked for counts as known; finish() refuses the others.
class ObjectNode {
public:
  explicit ObjectNode(const Node& node);

  Node require(const std::string& key);
  std::optional<Node> find(const std::string& key);
  double number_or(const std::string& key, double otherwise);
  double non_negative_or(const std::string& key, double otherwise);
  double positive_or(const std::string& key, double otherwise);
  Vec3 vector_or(const std::string& key, const Vec3& otherwise);
  /// The one key of the given that is there, none or two being errors.
  std::string require_one(const std::vector<std::string>& keys);
  /// Refuses keys that nobody asked for, naming the nearest known one.
  void finish() const;
  [[noreturn]] void fail(const std::string& message) const { node_.fail(message); }
  const Node& node() const { return node_; }

private:
  std::string listed_keys() const; ///< of the object; among them may be a missing one, misspelt
  Node node_;
  std::set<std::string> known_;
};

} // namespace dss
