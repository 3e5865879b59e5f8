#include "variants/cost/part_cost.hpp"

#include <algorithm>

namespace dss {
namespace {

/// Times of the passes of an overlapped step, cut as RowExecutor::make_blocks does. Exact for
/// strips of full rows, approximate for other parts.
void cut_passes(const PartSize& size, StepSweeps sweeps, int reach, double speed,
                PartTimes& times) {
  const auto has = [&](Side side) {
    return std::ranges::any_of(size.faces,
                               [&](const PartSize::Face& face) { return face.side == side; });
  };
  // Time of one row in one stage.
  const double row_s = double(size.row_elements[0]) / size.own_rows / speed;
  const int stages = sweeps.stages, halo = sweeps.count() * reach;
  const bool is_split = has(Side::upper) && size.own_rows >= 4 * halo;
  // Its last stage has `halo` rows. Each stage before has more on both sides: a reach a sweep.
  const int more = reach * sweeps.a_stage() * (stages - 1),
            more_sweeps = reach * (sweeps.count() - 1);
  if (is_split) times.upper_s = row_s * stages * (halo + more);
  const double lower_s = times.compute_s - times.upper_s;
  const int lower_rows = size.own_rows - (is_split ? halo : 0);
  // Each sweep of a split part's lower block has as many rows; else the first has the most.
  const int first_rows = lower_rows + (is_split ? 0 : more_sweeps);
  const double done_at = double(halo + more_sweeps) / first_rows;
  times.edge_s = has(Side::lower) ? lower_s * std::min(1.0, done_at) : 0;
}

} // namespace

int halo_depth(const HaloStrategy& strategy, StepSweeps sweeps) {
  return sweeps.halo(strategy.is_every_stage);
}

double element_stages(const PartSize& size, const HaloStrategy& strategy, StepSweeps sweeps) {
  if (strategy.is_every_stage) return double(size.row_elements[0]) * sweeps.stages;
  double sum = 0;
  for (std::size_t layer = 0; layer < size.row_elements.size(); ++layer) {
    const int without = (int(layer) + sweeps.a_stage() - 1) / sweeps.a_stage();
    sum += double(size.row_elements[layer]) * std::max(0, sweeps.stages - without);
  }
  return sum;
}

PartTimes part_times(const PartSize& size, const HaloStrategy& strategy, StepSweeps sweeps,
                     int reach, const NodeSpeed& speed) {
  PartTimes times;
  times.compute_s = element_stages(size, strategy, sweeps) / speed.of(strategy);
  if (!sweeps.has_pressure) // pressures need the halo first
    times.inner_s = times.compute_s * double(size.inner_elements) /
                    double(std::max<std::size_t>(1, size.row_elements[0]));
  if (strategy.is_overlapped && !strategy.is_every_stage)
    cut_passes(size, sweeps, reach, speed.of(strategy), times);
  return times;
}

PlannedPart plan_part(const PartSize& size, const PartTimes& times, Precision precision) {
  const std::size_t element_bytes = field_count * (precision == Precision::f64 ? 8 : 4);
  PlannedPart part{times, {}};
  for (const PartSize::Face& face : size.faces)
    part.faces.push_back(
        {face.part, face.side, face.send * element_bytes, face.receive * element_bytes});
  return part;
}

} // namespace dss
