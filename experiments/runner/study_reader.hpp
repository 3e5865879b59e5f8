#pragma once
/// Reads JSON with the place of every value at hand, so that an error says where it is.
#include "solver/error.hpp"

#include <fmt/format.h>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace dss {

/// A value of a JSON file with its JSON pointer.
class JsonPlace {
public:
  JsonPlace(const nlohmann::json& value, std::string file, std::string pointer = "")
      : value_(value), file_(std::move(file)), pointer_(std::move(pointer)) {}

  const nlohmann::json& value() const { return value_; }
  bool has(const std::string& key) const { return value_.is_object() && value_.contains(key); }

  [[noreturn]] void fail(const std::string& what) const { throw InputError(fmt::format("{}: {}", where(), what)); }
  /// File and pointer, as errors begin.
  std::string where() const { return fmt::format("{}: {}", file_, pointer_.empty() ? "/" : pointer_); }
  const std::string& file() const { return file_; }

  /// Requires an object with no other keys than these.
  void require_keys(std::initializer_list<const char*> allowed) const;
  /// @throws InputError that names all of these keys that are missing
  void must_have(std::initializer_list<const char*> keys) const;
  /// Member of an object. Fails if it is missing.
  JsonPlace operator[](const std::string& key) const;
  /// Elements of an array; a single value counts as an array of one.
  std::vector<JsonPlace> items() const;

  std::string text() const;
  std::vector<std::string> texts() const;
  bool flag() const;
  double positive() const;
  long count(long least) const;
  std::vector<int> whole_numbers() const; ///< of either sign, one at least

private:
  const nlohmann::json& value_;
  std::string file_, pointer_;
};

/// Parses a JSON file. @throws InputError with line and column if it is broken
nlohmann::json parse_json_file(const std::string& path);

} // namespace dss
