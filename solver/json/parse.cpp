#include "solver/json/parse.hpp"

#include "solver/error.hpp"
#include "solver/io/atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

namespace dss {
namespace {

using nlohmann::json;

/// Follows the parser and notes the first key that stands twice in its object. The library would
/// silently keep the last one.
class RepeatedKey {
public:
  void see(std::size_t depth, json::parse_event_t event, const json& value) {
    using Event = json::parse_event_t;
    if (event == Event::object_end || event == Event::array_end) return;
    open_.resize(depth);
    if (event == Event::key) return see_key(value.get_ref<const std::string&>());
    if (depth > 0) ++open_.back().items;
    if (event != Event::value) open_.push_back({event == Event::array_start, 0, "", {}});
  }
  /// JSON pointer of the key; empty if no key stands twice.
  const json::json_pointer& pointer() const { return pointer_; }

private:
  /// An object or array that has begun.
  struct Open {
    bool is_array;
    std::size_t items; ///< seen so far
    std::string key;   ///< the last one
    std::set<std::string> keys;
  };

  void see_key(const std::string& key) {
    open_.back().key = key;
    if (open_.back().keys.insert(key).second || !pointer_.empty()) return;
    for (const Open& one : open_)
      pointer_ = one.is_array ? pointer_ / (one.items - 1) : pointer_ / one.key;
  }

  std::vector<Open> open_;
  json::json_pointer pointer_;
};

/// Line and column, both from 1, of a byte in the text.
std::string line_and_column(const std::string& text, std::size_t byte) {
  const auto end = text.begin() + std::ptrdiff_t(std::min(byte, text.size()));
  const auto line_start = std::find(std::make_reverse_iterator(end), text.rend(), '\n').base();
  return fmt::format("line {}, column {}", 1 + std::count(text.begin(), end, '\n'),
                     1 + (end - line_start));
}

/// The library's words without its number of the error, in one line of ASCII: they repeat a part of
/// the text, which may be no UTF-8.
std::string detail_of(const json::exception& error) {
  std::string words = error.what();
  if (const auto end = words.find("] "); end != std::string::npos) words.erase(0, end + 2);
  if (const auto place = words.find("syntax error"); place != std::string::npos)
    words.erase(0, place);
  std::replace_if(
      words.begin(), words.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return words;
}

} // namespace

json parse_json_file(const std::string& path, const std::set<std::string>& left_out) {
  const std::string text = read_text(path);
  if (text.empty()) throw InputError(fmt::format("{}: is empty; give a JSON file", path));
  RepeatedKey repeated;
  const auto follow = [&](int depth, json::parse_event_t event, json& value) {
    repeated.see(std::size_t(depth), event, value);
    return event != json::parse_event_t::key ||
           !left_out.contains(value.get_ref<const std::string&>());
  };
  json root;
  try {
    root = json::parse(text, follow);
  } catch (const json::parse_error& error) {
    throw InputError(fmt::format("{}: {}: not JSON: {}", path,
                                 line_and_column(text, std::max<std::size_t>(error.byte, 1) - 1),
                                 detail_of(error)));
  } catch (const json::exception& error) {
    throw InputError(
        fmt::format("{}: not usable JSON, a number is too large: {}", path, detail_of(error)));
  }
  if (const json::json_pointer& twice = repeated.pointer(); !twice.empty())
    throw InputError(fmt::format("{}: {}: key \"{}\" stands twice in one object", path,
                                 twice.to_string(), twice.back()));
  return root;
}

} // namespace dss
