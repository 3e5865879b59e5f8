/// Which rows the tasks of a pass bring into the cache ahead of their use.
#include "variants/api/cache_sizes.hpp"
#include "variants/engine/fetch_plan.hpp"
#include "variants/engine/packs.hpp"
#include "variants/engine/wavefront.hpp"

namespace dss {

// A row of the state is new to a tile when the first stage reads it. What a tile left for the next
// one is new to it, too.
template <class T, int W>
void WavefrontStep<T, W>::plan_fetches(const std::vector<PassTask>& order, int parity,
                                       std::vector<RowStage>& tasks) {
  const std::size_t pack_bytes = std::size_t(fields_ * W) * sizeof(T);
  if (packed_.rows.front().kernels == nullptr) return; // devices fetch nothing
  // What stays in L2 from pass to pass needs no fetch.
  if (own().state_bytes() < 2 * l2_bytes()) return;
  std::vector<long> packs;
  for (const RowStage& stage : tasks)
    packs.push_back(stage.work == RowWork::stage ? stage.task.packs : 0);
  FetchPlan plan(std::move(packs), shape_.steps * sweeps_.stages); // pressures fetch nothing
  LastTiles states(int(packed_.rows.size())), stage_rows(places_->stage_rows_size()),
      links[] = {LastTiles(places_->links_size(0)), LastTiles(places_->links_size(1)),
                 LastTiles(places_->links_size(2))};
  for (std::size_t n = 0; n < order.size(); ++n) {
    if (order[n].is_extra()) continue;
    const int tile = order[n].tile, sweep = order[n].sweep, s = sweeps_.stage(sweep),
              r = order[n].row;
    const Row& row = packed_.lattice.rows[std::size_t(r)];
    const auto bytes = [&](int of) {
      return std::size_t(packed_.rows[std::size_t(of)].packs) * pack_bytes;
    };
    const auto read_state = [&](int of) {
      if (states.touch(of, tile)) plan.first_read(n, state_row(of, parity), bytes(of));
    };
    each_input(packed_.lattice, extra_links_.rows(), order[n], [&](int of) {
      if (of == row.upper_x) return; // of that piece, only the first pack is read
      if (s == 0)
        read_state(of);
      else if (seams_->owner(sweeps_.of_stage(s - 1), of, block_) == block_ &&
               stage_rows.touch(places_->stage_row(s - 1, of), tile))
        plan.first_read(n, stage_row(s - 1, of), bytes(of));
    });
    read_state(r);
    for (const int axis : {0, 1, 2}) {
      LastTiles& of_axis = links[axis];
      const int from = row.lower(axis);
      if (from >= 0 && of_axis.touch(places_->links(axis, sweep, from), tile)) {
        const int left = axis == 0 ? 1 : packed_.rows[std::size_t(from)].packs;
        plan.first_read(n, this->links(axis, sweep, from),
                        std::size_t(left) * std::size_t(packed_.carry_size) * sizeof(T));
      }
      if (row.upper(axis) >= 0) of_axis.touch(places_->links(axis, sweep, r), tile);
    }
    if (s + 1 < sweeps_.stages && !sweeps_.is_pressure(sweep))
      stage_rows.touch(places_->stage_row(s, r), tile);
  }
  for (std::size_t n = 0; n < tasks.size(); ++n)
    tasks[n].task.fetch = plan.fetches()[n].row,
    tasks[n].task.fetch_lines = plan.fetches()[n].lines;
}

#define DSS_INSTANTIATE(T, W)                                                                      \
  template void WavefrontStep<T, W>::plan_fetches(const std::vector<PassTask>&, int,               \
                                                  std::vector<RowStage>&);
DSS_EACH_PACK(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE

} // namespace dss
