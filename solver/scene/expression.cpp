#include "solver/scene/expression.hpp"

#include "solver/error.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <array>
#include <cmath>
#include <memory>
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

std::function<double(const Vec3& place)> function_of_place(const std::string& expression,
                                                           const Parameters& parameters) {
  struct Function { // the parser refers to the place
    mu::Parser parser;
    Vec3 place{};
  };
  const auto function = std::make_shared<Function>();
  try {
    function->parser = parser_of(expression);
    for (const auto& [name, number] : parameters) function->parser.DefineConst(name, number);
    constexpr std::array names{"x", "y", "z"};
    for (std::size_t a = 0; a < names.size(); ++a)
      if (!parameters.contains(names[a])) function->parser.DefineVar(names[a], &function->place[a]);
    function->parser.Eval(); // finds mistakes
    if (function->parser.GetUsedVar().empty()) return {};
  } catch (const mu::Parser::exception_type&) {
    return {};
  }
  return [function, expression](const Vec3& place) {
    function->place = place;
    const double value = function->parser.Eval();
    if (!std::isfinite(value))
      throw InputError(
          fmt::format("\"={}\" is {} at [{:.6g}, {:.6g}, {:.6g}] m, not a finite number",
                      expression, value, place[0], place[1], place[2]));
    return value;
  };
}

} // namespace dss
