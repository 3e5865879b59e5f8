/// Reads scenes as every command does. Prints one line each: "ok NAME ELEMENTS LINKS" or "refused
/// MESSAGE".
#include "solver/error.hpp"
#include "solver/scene/scene.hpp"

#include <iostream>
#include <string>

int main(int count, char** arguments) {
  for (int k = 1; k < count; ++k) {
    try {
      const dss::Scene scene = dss::load_scene(arguments[k]);
      std::cout << "ok " << scene.name << ' ' << scene.problem.lattice.element_count << ' '
                << scene.problem.link_count() << '\n';
    } catch (const dss::InputError& error) {
      std::cout << "refused " << error.what() << '\n';
    }
  }
}
