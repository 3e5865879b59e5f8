/// Reads studies as `dssbench experiment FILE --scale smoke --dry-run` does. After each plan it
/// prints one line: "== ok" or "== refused MESSAGE".
#include "experiments/studies/run_study.hpp"
#include "solver/error.hpp"

#include <fmt/format.h>

int main(int count, char** arguments) {
  for (int k = 1; k < count; ++k) {
    try {
      dss::run_study_file(arguments[k], {"smoke", "results", false, true});
      fmt::print("\n== ok\n");
    } catch (const dss::InputError& error) {
      fmt::print("\n== refused {}\n", error.what());
    }
  }
}
