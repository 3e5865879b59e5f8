#pragma once
/// Expressions in scenes: "=floor(n/4)".
#include <map>
#include <set>
#include <string>

namespace dss {

using Parameters = std::map<std::string, double>;

/// Value of an expression over named numbers, by muParser: + - * / ^, ?:, min, max, sqrt, sin, cos,
/// ... This function adds floor, ceil and pi.
/// @throws InputError that says what is wrong with the expression; the caller adds the place in the
///     file
double evaluate(const std::string& expression, const Parameters& parameters);

/// Names of numbers that an expression uses; none if it is not one.
std::set<std::string> names_in(const std::string& expression);

} // namespace dss
