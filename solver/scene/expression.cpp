#include "solver/scene/expression.hpp"

#include "solver/error.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <cmath>
#include <numbers>

namespace dss {

namespace {

/// The functions and constants of expressions.
mu::Parser parser_of(const std::string& expression) {
  mu::Parser parser;
  parser.DefineFun("floor", static_cast<double (*)(double)>(std::floor));
  parser.DefineFun("ceil", static_cast<double (*)(double)>(std::ceil));
  parser.DefineConst("pi", std::numbers::pi);
  parser.SetExpr(expression);
  return parser;
}

} // namespace

double evaluate(const std::string& expression, const Parameters& parameters) {
  double value = 0;
  try {
    mu::Parser parser = parser_of(expression);
    for (const auto& [name, number] : parameters) parser.DefineConst(name, number);
    value = parser.Eval();
  } catch (const mu::Parser::exception_type& error) {
    throw InputError(fmt::format("\"={}\" is not an expression over the scene's parameters: {}",
                                 expression, error.GetMsg()));
  }
  if (!std::isfinite(value))
    throw InputError(fmt::format("\"={}\" is {}, not a finite number", expression, value));
  return value;
}

std::set<std::string> names_in(const std::string& expression) {
  std::set<std::string> names;
  try {
    const mu::Parser parser = parser_of(expression);
    for (const auto& used : parser.GetUsedVar()) names.insert(used.first);
  } catch (const mu::Parser::exception_type&) {
    return {};
  }
  return names;
}

} // namespace dss
