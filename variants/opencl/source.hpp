#pragma once
/// Programs for a device: the shared physics, words for it, and the loops over rows of this folder's device/.
#include "kernels/physics.hpp"
#include "solver/model/model.hpp"

#include <string>
#include <vector>

namespace dss::opencl {

/// What a program is for.
struct ProgramKind {
  Model model = Model::spatial;
  Precision precision = Precision::f64;
  int lanes = 1;
  bool has_items = false;    ///< a work-item is a lane (GPUs), else a work-item goes along rows of packs (CPUs)
  bool has_leapfrog = false; ///< steps of leapfrog, else stages of Runge-Kutta methods
  bool has_rates = false;    ///< and rates for a host that updates
  int leapfrog_fields = 0;   ///< of a pack
  std::vector<Terms> terms;  ///< the combinations that rows name by their place here
};

/// Kernels run_passes and run_rows.
std::string row_program(const ProgramKind& kind);
/// Kernel evaluate_extra_links.
std::string extra_link_program(const ProgramKind& kind);

} // namespace dss::opencl
