#include "variants/cost/balance_model.hpp"

#include "variants/cost/halo_cost.hpp"

#include <algorithm>

namespace dss {
namespace {

PlannedPart strip(const ModelledPlate& plate, const HaloStrategy& strategy, int index,
                  int own_rows) {
  const std::size_t row = std::size_t(plate.rows);
  const int other_rows = plate.rows - own_rows;
  PartSize size;
  size.own_elements = std::size_t(own_rows) * row;
  size.own_rows = own_rows;
  size.row_elements = {size.own_elements};
  for (int layer = 0; layer < std::min(plate.stages, other_rows); ++layer)
    size.row_elements.push_back(row);
  size.layer_elements.assign(size.row_elements.begin() + 1, size.row_elements.end());
  size.inner_elements = size.own_elements - row;
  size.faces = {{1 - index, index == 0 ? Side::upper : Side::lower,
                 row * std::size_t(std::min(plate.stages, own_rows)),
                 row * std::size_t(std::min(plate.stages, other_rows))}};
  const double speed = (index == 0 ? plate.fast_speed : plate.slow_speed) * plate.stages;
  PlannedPart part{part_times(size, strategy, plate.stages, 1, {"", speed, speed}), {}};
  for (const PartSize::Face& face : size.faces)
    part.faces.push_back({face.part, face.side, face.send * std::size_t(plate.element_bytes),
                          face.receive * std::size_t(plate.element_bytes)});
  return part;
}

} // namespace

double modelled_step_s(const ModelledPlate& plate, int fast_rows) {
  const HaloStrategy& strategy = *find_halo_strategy(plate.is_overlapped ? "deep-overlap" : "deep");
  return predicted_step_s(
      {std::string(strategy.name),
       1,
       {strip(plate, strategy, 0, fast_rows), strip(plate, strategy, 1, plate.rows - fast_rows)}},
      plate.link);
}

ModelledBalance modelled_balance(const ModelledPlate& plate) {
  const double elements = double(plate.rows) * plate.rows;
  const double sum_s = elements / (plate.fast_speed + plate.slow_speed),
               fast_s = elements / plate.fast_speed;
  ModelledBalance best;
  for (int fast_rows = 1; fast_rows < plate.rows; ++fast_rows)
    if (const double step_s = modelled_step_s(plate, fast_rows);
        best.step_s == 0 || step_s < best.step_s)
      best.step_s = step_s, best.fast_share = double(fast_rows) / plate.rows;
  best.of_sum = sum_s / best.step_s;
  best.of_fast = fast_s / best.step_s;
  best.equal_split_of_fast = fast_s / modelled_step_s(plate, plate.rows - plate.rows / 2);
  return best;
}

} // namespace dss
