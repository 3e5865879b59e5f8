#pragma once
/// Elements of a body picked by face, coordinate box or list.
#include "solver/model/problem.hpp"
#include "solver/scene/json/node.hpp"

#include <string>
#include <vector>

namespace dss {

/// Names of the faces: "-x", "+x", "-y", "+y", "-z", "+z"; the axis is index / 2, the upper ones are odd.
extern const std::vector<std::string> face_names;

/// The body that "body" names; it may be absent where the scene has a single one.
int read_body(ObjectNode& object, const Problem& problem);

/// Reads one of "face", "box", "elements" or "all" of an object; does not finish it.
/// @return numbers of the elements, ascending and each once, but in the order listed for "elements"
/// @throws InputError if it selects nothing
std::vector<std::size_t> read_selection(ObjectNode& select, const Problem& problem, int body);

/// Reads "body" and "select" of an object; "select" may be absent for the whole body where `is_all_by_default`.
std::vector<std::size_t> read_selected(ObjectNode& object, const Problem& problem, bool is_all_by_default);

} // namespace dss
