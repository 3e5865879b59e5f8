#pragma once
/// Names of methods in scenes and studies.
#include "solver/json/node.hpp"

#include <string>

namespace dss {

/// The name of a method, as find_method takes it. @throws InputError if it is none
std::string method_name_in(const Node& node);

} // namespace dss
