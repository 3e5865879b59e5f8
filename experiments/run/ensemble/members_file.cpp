#include "experiments/run/ensemble/members_file.hpp"

#include "experiments/base/records.hpp"
#include "solver/error.hpp"
#include "solver/json/object_node.hpp"
#include "solver/json/parse.hpp"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>

namespace dss {
namespace {

std::vector<MemberSet> members_of_json(const std::string& path) {
  const JsonFile file(path, parse_json_file(path));
  ObjectNode root{Node(file)};
  root.name_or("$schema", "");
  std::vector<MemberSet> members;
  for (const Node& item : root.require("members").items()) {
    ObjectNode object(item);
    MemberSet member{object.name_or("name", std::to_string(members.size() + 1)), {}};
    if (const auto set = object.find("set"))
      for (const auto& [key, value] : ObjectNode(*set).members())
        member.set.push_back(read_override(key, value));
    object.finish();
    members.push_back(std::move(member));
  }
  root.finish();
  return members;
}

std::vector<MemberSet> members_of_csv(const std::string& path) {
  const Table table = read_csv(path);
  std::vector<MemberSet> members;
  std::vector<std::string> columns = table.columns;
  std::ranges::sort(columns);
  if (const auto twice = std::ranges::adjacent_find(columns); twice != columns.end())
    throw InputError(fmt::format("{}: two columns are named \"{}\"; names differ", path, *twice));
  for (const Record& row : table.rows) {
    if (std::ranges::all_of(row, [](const auto& item) { return item.second.empty(); }))
      throw InputError(fmt::format("{}: row {} is empty; give its member a name or a value", path,
                                   members.size() + 1));
    const std::string number = std::to_string(members.size() + 1), named = text_in(row, "name");
    MemberSet member{named.empty() ? number : named, {}};
    for (const std::string& key : table.columns)
      if (key != "name" && !row.at(key).empty()) member.set.push_back({key, row.at(key)});
    members.push_back(std::move(member));
  }
  return members;
}

std::vector<MemberSet> equal_members(const std::string& number) {
  constexpr long most = 1'000'000;
  const long count = number.size() > 7 ? most + 1 : std::stol(number);
  if (count < 1 || count > most)
    throw InputError(fmt::format("--ensemble {}: give 1 to {} members", number, most));
  std::vector<MemberSet> members;
  for (long n = 1; n <= count; ++n) members.push_back({std::to_string(n), {}});
  return members;
}

/// Names become parts of file names.
void require_name(const std::string& path, const std::string& name) {
  const auto is_plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.' || c == '+';
  };
  if (!std::ranges::all_of(name, is_plain) || name.front() == '.')
    throw InputError(fmt::format("{}: member \"{}\": a name is part of file names; use letters, "
                                 "digits, and - _ + . inside",
                                 path, name));
}

} // namespace

std::vector<MemberSet> read_members(const std::string& file_or_number) {
  const std::string& path = file_or_number;
  if (!path.empty() && std::ranges::all_of(path, [](unsigned char c) { return std::isdigit(c); }))
    return equal_members(path);
  const bool is_csv = path.ends_with(".csv");
  if (!is_csv && !path.ends_with(".json"))
    throw InputError(fmt::format(
        "--ensemble {}: give a file that ends in .json or .csv, or a number of equal members",
        path));
  std::vector<MemberSet> members = is_csv ? members_of_csv(path) : members_of_json(path);
  if (members.empty())
    throw InputError(fmt::format("{}: has no members; an ensemble has at least one", path));
  std::vector<std::string> names;
  for (const MemberSet& member : members) {
    require_name(path, member.name);
    names.push_back(member.name);
  }
  std::ranges::sort(names);
  if (const auto twice = std::ranges::adjacent_find(names); twice != names.end())
    throw InputError(fmt::format("{}: two members are named \"{}\"; names differ", path, *twice));
  return members;
}

} // namespace dss
