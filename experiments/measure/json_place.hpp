#pragma once
/// Reads JSON and keeps the place of every value, so that error messages can name it.
#include "solver/error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace dss {

/// A value of a JSON file with its JSON pointer. It refers to the value, which must outlive it.
/// Functions that read a value throw InputError with the place if the value is not of the kind that
/// they read.
class JsonPlace {
public:
  JsonPlace(const nlohmann::json& value, std::string file, std::string pointer = "")
      : value_(value), file_(std::move(file)), pointer_(std::move(pointer)) {}

  const nlohmann::json& value() const { return value_; }
  bool has(const std::string& key) const { return value_.is_object() && value_.contains(key); }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", where(), what));
  }
  /// File and pointer; error messages begin with it.
  std::string where() const {
    return fmt::format("{}: {}", file_, pointer_.empty() ? "/" : pointer_);
  }
  const std::string& file() const { return file_; }

  /// Requires an object without other keys than `allowed`.
  void require_keys(const std::vector<std::string>& allowed) const;
  /// @throws InputError that names all of these keys that are missing
  void must_have(const std::vector<std::string>& keys) const;
  /// Member of an object. @throws InputError if it is missing
  JsonPlace operator[](const std::string& key) const;
  /// Elements of an array; a single value counts as an array of one.
  std::vector<JsonPlace> items() const;

  std::string text() const;
  std::vector<std::string> texts() const;
  bool flag() const;
  double positive() const;
  long count(long least) const;
  std::vector<int> whole_numbers() const; ///< at least one; negative numbers are allowed

private:
  const nlohmann::json& value_;
  std::string file_, pointer_;
};

/// Parses a JSON file. @throws InputError with line and column if it is broken
nlohmann::json parse_json_file(const std::string& path);

} // namespace dss
