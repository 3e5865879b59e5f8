#include "solver/scene/expression.hpp"

#include "solver/error.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <cmath>
#include <numbers>

namespace dss {

double evaluate(const std::string& expression, const Parameters& parameters) {
  double value = 0;
  try {
    mu::Parser parser;
    parser.DefineFun("floor", static_cast<double (*)(double)>(std::floor));
    parser.DefineFun("ceil", static_cast<double (*)(double)>(std::ceil));
    parser.DefineConst("pi", std::numbers::pi);
    for (const auto& [name, number] : parameters) parser.DefineConst(name, number);
    parser.SetExpr(expression);
    value = parser.Eval();
  } catch (const mu::Parser::exception_type& error) {
    throw InputError(fmt::format("\"={}\" is not an expression over the scene's parameters: {}",
                                 expression, error.GetMsg()));
  }
  if (!std::isfinite(value))
    throw InputError(fmt::format("\"={}\" is {}, not a finite number", expression, value));
  return value;
}

} // namespace dss
