#pragma once
/// Expressions in scenes: "=floor(n/4)".
#include "solver/json/node.hpp"

#include <map>
#include <string>

namespace dss {

using Parameters = std::map<std::string, double>;

/// Value of an expression over named numbers, by muParser: + - * / ^, ?:, min, max, sqrt, sin, cos,
/// ... This function adds floor, ceil and pi.
/// @throws InputError that says what is wrong with the expression; the caller adds the place in the
///     file
double evaluate(const std::string& expression, const Parameters& parameters);

/// Named expressions over parameters and the coordinates of a place.
using Fields = std::map<std::string, std::string>;

/// The function of an expression over named numbers, fields and the coordinates x, y, z of a place
/// [m]. A number of the same name hides a coordinate.
/// @return none if the expression uses neither coordinate nor field, or is none
/// @throws InputError, the function, if its value is not finite
PlaceFunction function_of_place(const std::string& expression, const Parameters& parameters,
                                const Fields& fields);

} // namespace dss
