#include "experiments/studies/kernels/attribution.hpp"

namespace dss {

const std::vector<std::string>& attribution_columns() {
  static const std::vector<std::string> columns = {"variant",
                                                   "model",
                                                   "precision",
                                                   "scene",
                                                   "n",
                                                   "threads",
                                                   "part",
                                                   "count_per_step",
                                                   "measured_ns_per_element_step",
                                                   "measured_ns_per_element_step_low",
                                                   "measured_ns_per_element_step_high",
                                                   "share_of_step",
                                                   "share_of_step_low",
                                                   "share_of_step_high",
                                                   "measured_in_l1_ns",
                                                   "measured_in_l1_ns_low",
                                                   "measured_in_l1_ns_high",
                                                   "flops_per_element_step",
                                                   "share_of_peak",
                                                   "share_of_peak_low",
                                                   "share_of_peak_high",
                                                   "peak_bound_ns",
                                                   "peak_bound_ns_low",
                                                   "peak_bound_ns_high",
                                                   "mix_bound_ns",
                                                   "mix_bound_ns_low",
                                                   "mix_bound_ns_high",
                                                   "mix_without_stack_bound_ns",
                                                   "mix_without_stack_bound_ns_low",
                                                   "mix_without_stack_bound_ns_high",
                                                   "traffic_bound_ns",
                                                   "share_of_ceiling",
                                                   "share_of_ceiling_low",
                                                   "share_of_ceiling_high",
                                                   "share_of_ceiling_in_l1",
                                                   "share_of_ceiling_in_l1_low",
                                                   "share_of_ceiling_in_l1_high",
                                                   "limiter",
                                                   "sum_over_step",
                                                   "sum_over_step_low",
                                                   "sum_over_step_high",
                                                   "fma",
                                                   "sums",
                                                   "products",
                                                   "shuffles",
                                                   "loads",
                                                   "stores",
                                                   "stack_loads",
                                                   "stack_stores",
                                                   "status",
                                                   "reason"};
  return columns;
}

const std::vector<std::string>& attribution_raw_columns() {
  static const std::vector<std::string> columns = {"variant", "model",    "precision", "scene",
                                                   "n",       "threads",  "timed",     "round",
                                                   "passes",  "elements", "wall_s",    "time_utc"};
  return columns;
}

} // namespace dss
