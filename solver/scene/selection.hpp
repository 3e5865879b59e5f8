#pragma once
/// Selection of elements of a body by face, box of indices, list, material or place.
#include "solver/json/object_node.hpp"
#include "solver/model/problem.hpp"
#include "solver/scene/place_selection.hpp"

#include <optional>
#include <string>
#include <vector>

namespace dss {

/// Names of the faces: "-x", "+x", "-y", "+y", "-z", "+z". The axis is index / 2; upper faces have
/// odd indices.
extern const std::vector<std::string> face_names;

/// Index of the body named by "body". "body" may be absent if the scene has a single body.
int read_body(ObjectNode& object, const Problem& problem);

/// Reads one of "face", "box", "elements", "material", "all" or place_keys of an object. Does not
/// call finish() on it.
/// @return numbers of the elements, each once; ascending, but for "elements" in the given order
/// @throws InputError if nothing is selected
std::vector<std::size_t> read_selection(ObjectNode& select, const Problem& problem, int body,
                                        const BodySurfaces& surfaces);

/// The face that "select" of an object names, as an index of face_names, if it names one.
std::optional<std::size_t> selected_face(ObjectNode& object);

/// Reads "body" and "select" of an object. If `is_all_by_default`, "select" may be absent and means
/// the whole body.
std::vector<std::size_t> read_selected(ObjectNode& object, const Problem& problem,
                                       const BodySurfaces& surfaces, bool is_all_by_default);

} // namespace dss
