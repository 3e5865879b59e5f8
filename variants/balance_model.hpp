#pragma once
/// A model, not a measurement: what two executors of unlike speed (a CPU and a GPU, say) reach together on a plate, with rates and
/// transfer costs as data. Steps are replayed as in halo_cost.hpp; nothing is computed.
#include "variants/distribution.hpp"

namespace dss {

/// A plate of rows x rows elements, cut across into two strips that exchange deep halos.
struct ModelledPlate {
  int rows = 0, stages = 4;
  double fast_speed = 0, slow_speed = 0; ///< of each alone, element-steps a second
  Network link;                          ///< between the two: of PCIe, say
  bool is_overlapped = false;            ///< halos are sent early and under way while the rest is computed
  int element_bytes = 104;               ///< of a halo element: 13 numbers
};

/// What the model says of a plate.
struct ModelledBalance {
  double fast_share = 0; ///< of the elements: the whole number of rows, one at least for each, of the shortest step
  double step_s = 0;     ///< of that
  double of_sum = 0;     ///< throughput over the sum of both speeds
  double of_fast = 0;    ///< throughput over the fast one alone: below 1, joining does not pay
  double equal_split_of_fast = 0; ///< the same of two halves
};

/// Seconds a step if the fast one has so many rows.
double modelled_step_s(const ModelledPlate& plate, int fast_rows);
ModelledBalance modelled_balance(const ModelledPlate& plate);

} // namespace dss
