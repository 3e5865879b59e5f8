#pragma once
/// Cells and records as an experiment would have written them, for tests of derived tables.
#include "experiments/measure/cell.hpp"
#include "experiments/measure/samples.hpp"

#include <fmt/format.h>
#include <string>

namespace dss {

inline Cell cell(const std::string& variant, int threads, long steps = 100, bool is_twin = false) {
  Cell result;
  result.scene = "plate_paper";
  result.set = {{"n", "10"}};
  result.variant = variant;
  result.threads = threads;
  result.model = "spatial";
  result.precision = "f64";
  result.integrator = "rk4";
  result.steps = steps;
  result.full_steps = 100;
  result.is_twin = is_twin;
  return result;
}

inline Record row(const Cell& of, long repetition, double wall_s) {
  return {{"cell", of.key()},
          {"scale", "host"},
          {"repetition", fmt::format("{}", repetition)},
          {"wall_s", number_text(wall_s)},
          {"steps", fmt::format("{}", of.steps)},
          {"elements", "100"},
          {"threads", fmt::format("{}", of.threads)},
          {"ranks", fmt::format("{}", of.ranks)},
          {"cores", "2"},
          {"twin", of.is_twin ? "true" : "false"},
          {"has_fma", of.variant.starts_with("avx") ? "true" : "false"},
          {"check", "passed"},
          {"check_error", "1e-15"},
          {"status", "ok"},
          {"state_digest", "00ff"},
          {"contaminated", "false"}};
}

inline Cell on_ranks(Cell of, int ranks, const std::string& halo = "auto") {
  of.ranks = ranks;
  of.halo = halo;
  return of;
}

} // namespace dss
