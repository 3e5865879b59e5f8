#include "variants/api/member.hpp"

#include "solver/error.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <string_view>

namespace dss {
namespace {

constexpr std::string_view grammar =
    "members are VARIANT[@DEVICE][:THREADS][=WEIGHT], separated by commas";

bool is_number(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

/// Reads one list of members from left to right.
class Reader {
public:
  explicit Reader(std::string_view text) : rest_(text) {}

  std::vector<Member> all() {
    std::vector<Member> members{next()};
    while (take(',')) members.push_back(next());
    const auto weighted =
        std::ranges::count_if(members, [](const Member& member) { return member.weight > 0; });
    if (weighted != 0 && std::size_t(weighted) != members.size())
      throw InputError(
          fmt::format("hybrid: {} of {} members have a weight; give one to each, or to none",
                      weighted, members.size()));
    return members;
  }

private:
  Member next() {
    begin_ = rest_;
    Member member;
    member.variant = until(",@:=[]");
    if (member.variant.empty()) fail("has no variant");
    if (take('@')) member.device = device();
    if (take(':')) member.threads = threads();
    if (take('=')) member.weight = weight();
    if (!rest_.empty() && rest_.front() != ',') fail(fmt::format("\"{}\" is too much", rest_));
    return member;
  }
  std::string device() {
    std::string found;
    if (take('[')) {
      found = until("]");
      if (!take(']')) fail("the bracket is not closed");
    } else if (found = until(",:=[]"); is_number(found)) {
      fail(fmt::format("device {} is a number; write a device in brackets, as in @[0:1]", found));
    }
    if (found.empty()) fail("has no device behind the @");
    return found;
  }
  int threads() {
    const std::string text = until(",=");
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || number < 1)
      fail(fmt::format("\"{}\" is not a number of threads; take 1 or more", text));
    return number;
  }
  double weight() {
    const std::string text = until(",");
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || !(number > 0) ||
        !std::isfinite(number))
      fail(fmt::format("\"{}\" is not a weight; take a positive number", text));
    return number;
  }
  std::string until(std::string_view ends) {
    const std::string_view found = rest_.substr(0, rest_.find_first_of(ends));
    rest_.remove_prefix(found.size());
    return std::string(found);
  }
  bool take(char c) {
    if (rest_.empty() || rest_.front() != c) return false;
    rest_.remove_prefix(1);
    return true;
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("hybrid: member \"{}\": {}; {}",
                                 begin_.substr(0, begin_.find(',')), what, grammar));
  }

  std::string_view rest_,
      begin_; ///< rest_: text not read yet; begin_: the same when the present member began
};

} // namespace

std::vector<Member> parse_members(const std::string& text) { return Reader(text).all(); }

std::string name(const Member& member) {
  std::string device;
  if (!member.device.empty()) {
    const bool is_plain =
        !is_number(member.device) && member.device.find_first_of(",:=[]") == std::string::npos;
    device = fmt::format(fmt::runtime(is_plain ? "@{}" : "@[{}]"), member.device);
  }
  return fmt::format("{}{}:{}", member.variant, device, member.threads);
}

} // namespace dss
