#pragma once
/// The members of an ensemble as users write them: a file with a set of overrides for each.
#include "solver/scene/scene_text.hpp"

#include <string>
#include <vector>

namespace dss {

/// One member: its scene with these overrides.
struct MemberSet {
  std::string name; ///< part of the names of its files
  std::vector<Override> set;
};

/// Reads members from a file, or makes so many equal ones from a number: "64".
/// NAME.json: {"members": [{"name": "soft", "set": {"k": 500}}, ...]} (members.schema.json).
/// NAME.csv: a row a member; the columns are keys of --set, and `name` if there is one. An empty
/// value leaves the key as it is.
/// Without a name, a member has its number, from 1 on.
/// @throws InputError with the place: no members, unknown keys, a name twice
std::vector<MemberSet> read_members(const std::string& file_or_number);

} // namespace dss
