#pragma once
/// Checks names in the JSON of studies. Errors name the nearest known name.
#include "kernels/fields.hpp"
#include "kernels/model.hpp"
#include "solver/json/node.hpp"
#include "variants/loading/loader.hpp"

namespace dss {

/// Finds a variant by name. @throws InputError with the place and the nearest known name
const VariantStatus& known_variant(const std::string& name, const Node& node);

/// Read a model and a precision. @throws InputError with the place and the nearest known name
Model model_in(const Node& node);
Precision precision_in(const Node& node);

/// Names of platforms. @throws InputError with the place and the nearest known name
std::vector<std::string> platforms_in(const Node& node);

/// Reads a field of an element. @throws InputError with the place and the nearest known name
Field field_in(const Node& node);

} // namespace dss
