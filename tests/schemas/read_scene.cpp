/// Reads scenes as every command does. Prints one line each: "== ok" or "== refused MESSAGE".
#include "solver/error.hpp"
#include "solver/scene/scene.hpp"

#include <fmt/format.h>

int main(int count, char** arguments) {
  for (int k = 1; k < count; ++k) {
    try {
      dss::load_scene(arguments[k]);
      fmt::print("== ok\n");
    } catch (const dss::InputError& error) {
      fmt::print("== refused {}\n", error.what());
    }
  }
}
