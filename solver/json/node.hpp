#pragma once
/// Typed view of a JSON file. Each value knows its place, so every error says what is wrong, where,
/// and what would be right.
#include "kernels/fields.hpp"
#include "solver/error.hpp"

#include <nlohmann/json.hpp>

#include <functional>
#include <string>
#include <vector>

namespace dss {

/// A number that depends on the place x, y, z [m]. It may throw InputError.
using PlaceFunction = std::function<double(const Vec3& place)>;

/// A parsed JSON file. A kind of file may let texts stand for numbers, and may change values: see
/// SceneText.
struct JsonFile {
  std::string path; ///< as shown in errors
  nlohmann::json root;

  JsonFile() = default;
  JsonFile(std::string shown_path, nlohmann::json whole)
      : path(std::move(shown_path)), root(std::move(whole)) {}
  virtual ~JsonFile() = default;

  /// True if the text at this JSON pointer stands for a number.
  virtual bool is_expression(const std::string& /*text*/, const std::string& /*pointer*/) const {
    return false;
  }
  /// Its number. @throws InputError without a place
  virtual double evaluate(const std::string& text) const;
  /// Its function of the place; none if it does not depend on it.
  virtual PlaceFunction function_of(const std::string& /*text*/) const { return {}; }
  /// How numbers may be written, for errors.
  virtual const char* number_forms() const { return "a number"; }
  /// What has changed the value at this JSON pointer, such as "--set n=4"; empty if nothing has.
  virtual std::string changed_by(const std::string& /*pointer*/) const { return {}; }
};

/// Returns "a, b, c" for the given names.
std::string listed(const std::vector<std::string>& names);

/// One value of a file, which must outlive it. Every read throws InputError "path: /json/pointer:
/// what is wrong" if the value is not as expected.
class Node {
public:
  static constexpr long most_whole = 1L << 53; ///< doubles hold all integers up to this one exactly

  explicit Node(const JsonFile& file) : Node(file, file.root, "") {}

  double number() const; ///< finite; a JSON number or an expression
  /// Of an expression over the place, such as "=9.81e3*(2-z)": its function. Of other numbers:
  /// none.
  PlaceFunction function_of_place() const;
  double positive() const;
  double non_negative() const;
  /// A number without a fraction, least <= number <= most.
  long whole(long least, long most = most_whole) const;
  int count(int least) const; ///< as whole, up to the largest int
  bool flag() const;
  std::string text() const;
  std::string name() const; ///< a text that is not empty
  Vec3 vector() const;      ///< [x, y, z]
  Vec3 positive_vector() const;

  std::vector<Node> items(std::size_t least = 0) const; ///< items of an array
  /// Items of an array that is not empty. A single value counts as an array of one.
  std::vector<Node> list() const;
  std::vector<std::string> names() const;    ///< of list()
  std::vector<double> non_negatives() const; ///< of list()
  std::vector<double> positives() const;     ///< of list()
  std::vector<int> counts(int least) const;  ///< of list()

  /// Index of a text among `names`. `what` is the kind of thing, for the error message.
  std::size_t choice(const char* what, const std::vector<std::string>& names) const;
  /// The text itself, which must be one of `names`.
  std::string known_name(const char* what, const std::vector<std::string>& names) const;

  bool is_array() const { return value_->is_array(); }
  bool is_object() const { return value_->is_object(); }
  bool is_string() const { return value_->is_string(); }
  bool is_number() const; ///< true for a JSON number or an expression
  const nlohmann::json& json() const { return *value_; }
  /// The value as text, short enough for one line.
  std::string shown() const;
  const std::string& file() const { return file_->path; }
  std::string where() const; ///< file and JSON pointer; errors begin with it
  [[noreturn]] void fail(const std::string& message) const;
  /// Calls `check` and gives its InputError this place.
  template <class Check>
  auto placed(Check&& check) const {
    try {
      return check();
    } catch (const InputError& error) {
      fail(error.what());
    }
  }

private:
  friend class ObjectNode;
  Node(const JsonFile& file, const nlohmann::json& value, std::string pointer)
      : file_(&file), value_(&value), pointer_(std::move(pointer)) {}
  Node member(const std::string& key, const nlohmann::json& value) const;
  std::string with_source(double value) const; ///< the number and its expression, for errors

  const JsonFile* file_;
  const nlohmann::json* value_;
  std::string pointer_;
};

} // namespace dss
