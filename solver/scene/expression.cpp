#include "solver/scene/expression.hpp"

#include "solver/error.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

namespace dss {

namespace {

/// A parser with the functions and constants of expressions, and the named numbers.
mu::Parser parser_of(const std::string& expression, const Parameters& parameters) {
  mu::Parser parser;
  parser.DefineFun("floor", static_cast<double (*)(double)>(std::floor));
  parser.DefineFun("ceil", static_cast<double (*)(double)>(std::ceil));
  parser.DefineConst("pi", std::numbers::pi);
  for (const auto& [name, number] : parameters) parser.DefineConst(name, number);
  parser.SetExpr(expression);
  return parser;
}

/// An expression over the place. Its parsers refer to the numbers beside them.
class PlaceExpression {
public:
  PlaceExpression(const std::string& text, const Parameters& parameters, const Fields& fields)
      : text_(text), values_(fields.size()), whole_(parser_over(text, parameters)) {
    for (const auto& [name, field] : fields) {
      whole_.DefineVar(name, &values_[fields_.size()]);
      fields_.push_back(parser_over(field, parameters));
    }
    evaluate(); // finds mistakes
  }
  PlaceExpression(const PlaceExpression&) = delete;

  bool depends_on_place() const { return !whole_.GetUsedVar().empty(); }
  double at(const Vec3& place) {
    place_ = place;
    const double value = evaluate();
    if (!std::isfinite(value))
      throw InputError(
          fmt::format("\"={}\" is {} at [{:.6g}, {:.6g}, {:.6g}] m, not a finite number", text_,
                      value, place[0], place[1], place[2]));
    return value;
  }

private:
  mu::Parser parser_over(const std::string& text, const Parameters& parameters) {
    mu::Parser parser = parser_of(text, parameters);
    constexpr std::array names{"x", "y", "z"};
    for (std::size_t a = 0; a < names.size(); ++a)
      if (!parameters.contains(names[a])) parser.DefineVar(names[a], &place_[a]);
    return parser;
  }
  double evaluate() {
    for (std::size_t n = 0; n < fields_.size(); ++n) values_[n] = fields_[n].Eval();
    return whole_.Eval();
  }

  std::string text_;
  Vec3 place_{};
  std::vector<double> values_; ///< of the fields
  std::vector<mu::Parser> fields_;
  mu::Parser whole_;
};

} // namespace

double evaluate(const std::string& expression, const Parameters& parameters) {
  double value = 0;
  try {
    value = parser_of(expression, parameters).Eval();
  } catch (const mu::Parser::exception_type& error) {
    throw InputError(fmt::format("\"={}\" is not an expression over the scene's parameters: {}",
                                 expression, error.GetMsg()));
  }
  if (!std::isfinite(value))
    throw InputError(fmt::format("\"={}\" is {}, not a finite number", expression, value));
  return value;
}

PlaceFunction function_of_place(const std::string& expression, const Parameters& parameters,
                                const Fields& fields) {
  try {
    const auto function = std::make_shared<PlaceExpression>(expression, parameters, fields);
    if (!function->depends_on_place()) return {};
    return [function](const Vec3& place) { return function->at(place); };
  } catch (const mu::Parser::exception_type&) {
    return {};
  }
}

} // namespace dss
