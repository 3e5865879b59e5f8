#include "solver/scene/method_name.hpp"

#include "solver/numerics/method.hpp"

namespace dss {

std::string method_name_in(const Node& node) {
  const std::string name = node.text();
  if (find_method(name) != nullptr) return name;
  if (name.starts_with(with_radius)) node.fail(why_no_method(name));
  return node.known_name("integrator", method_names());
}

} // namespace dss
