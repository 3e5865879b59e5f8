#pragma once
/// A model, not a measurement: what two executors of different speed, such as a CPU and a GPU,
/// reach together on a plate. Speeds and transfer costs are input. The model replays steps as
/// halo_cost.hpp does and computes no elements.
#include "variants/api/distribution.hpp"

namespace dss {

/// A plate of rows x rows elements, cut into two strips that exchange deep halos.
struct ModelledPlate {
  int rows = 0, stages = 4;
  double fast_speed = 0, slow_speed = 0; ///< of each executor alone [element-steps/s]
  Network link;                          ///< between the two executors, for example PCIe
  bool is_overlapped = false; ///< halos are sent early and travel during the rest of the step
  int element_bytes = 104;    ///< bytes of a halo element: 13 numbers
};

/// Result of the model.
struct ModelledBalance {
  /// Fraction of the elements that the fast executor has in the shortest step. Each executor has a
  /// whole number of rows, at least one.
  double fast_share = 0;
  double step_s = 0;  ///< the shortest step [s]
  double of_sum = 0;  ///< throughput divided by the sum of both speeds
  double of_fast = 0; ///< throughput divided by the fast speed; below 1: joining does not pay
  /// The same with half of the plate for each.
  double equal_split_of_fast = 0;
};

/// Predicted time of a step [s] if the fast executor has `fast_rows` rows.
double modelled_step_s(const ModelledPlate& plate, int fast_rows);
/// Tries every division of the rows and gives the best.
ModelledBalance modelled_balance(const ModelledPlate& plate);

} // namespace dss
