#pragma once
/// Typed view of a JSON object.
#include "solver/json/node.hpp"

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace dss {

/// An object of a file. Every key that is asked for counts as known. finish() refuses the others.
class ObjectNode {
public:
  /// @throws InputError with the place if the value is not an object
  explicit ObjectNode(const Node& node);

  Node require(const std::string& key);
  std::optional<Node> find(const std::string& key);
  bool has(const std::string& key) { return find(key).has_value(); }
  /// All members with their keys. Every key counts as known.
  std::vector<std::pair<std::string, Node>> members();

  double number_or(const std::string& key, double otherwise);
  double positive_or(const std::string& key, double otherwise);
  double non_negative_or(const std::string& key, double otherwise);
  long whole_or(const std::string& key, long least, long otherwise);
  bool flag_or(const std::string& key, bool otherwise);
  Vec3 vector_or(const std::string& key, const Vec3& otherwise);
  std::string name_or(const std::string& key, const std::string& otherwise);
  std::vector<std::string> names_or(const std::string& key,
                                    const std::vector<std::string>& otherwise);
  /// Names that must be among `known`. `what` is the kind of thing, for the error message.
  std::vector<std::string> known_names_or(const std::string& key, const char* what,
                                          const std::vector<std::string>& known,
                                          const std::vector<std::string>& otherwise);

  /// @throws InputError that names all of these keys that are missing
  void must_have(const std::vector<std::string>& keys);
  /// The one of these keys that is present. None or several are an error.
  std::string require_one(const std::vector<std::string>& keys);
  /// Counts these keys as known although they are not read.
  void allow(const std::vector<std::string>& keys) { known_.insert(keys.begin(), keys.end()); }
  /// Refuses keys that are not known, and names the nearest known key.
  void finish() const;
  [[noreturn]] void fail(const std::string& message) const { node_.fail(message); }
  const Node& node() const { return node_; }

private:
  std::string listed_keys() const; ///< keys of the object; one may be a misspelt key
  Node node_;
  std::set<std::string> known_;
};

} // namespace dss
