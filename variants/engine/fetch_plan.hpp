#pragma once
/// Which task brings which row into the cache ahead of its use. Beyond L2 the time of a row is
/// latency, not bandwidth, and rows of a tile do not follow one another in memory, so the processor
/// does not foresee them.
#include <cstddef>
#include <utility>
#include <vector>

namespace dss {

/// The tile that touched each of some rows last.
class LastTiles {
public:
  explicit LastTiles(int rows) : tiles_(std::size_t(rows), -1) {}
  /// @return whether the row is new to the tile
  bool touch(int row, int tile) { return std::exchange(tiles_[std::size_t(row)], tile) != tile; }

private:
  std::vector<int> tiles_;
};

/// Rows that tasks are the first to read, and the tasks that fetch them: each a part of one row,
/// along with each of its packs. A row is divided among several tasks, because the processor has
/// few buffers for cache lines that are on their way, and loads from L2 need them too.
class FetchPlan {
public:
  /// @param tasks   packs of each task in their order; 0: it cannot fetch
  /// @param shares  tasks among which a row is divided
  FetchPlan(std::vector<long> tasks, int shares);
  /// Tells that a task is the first to read a row since it left the cache. Tasks must come in
  /// ascending order. The row is divided among the nearest earlier tasks of about the reader's
  /// length. Without any, a long row is fetched by its reader, ahead of its own reading.
  void first_read(std::size_t task, const void* row, std::size_t bytes);

  struct Fetch {
    const char* row = nullptr;
    int lines = 0; ///< cache lines along with each pack of the task
  };
  const std::vector<Fetch>& fetches() const { return fetches_; }

  /// Packs from a fetch to the first use: some 2 us of work, several times the latency of the
  /// memory, since many lines are on their way at once.
  static constexpr long lead = 24;

private:
  /// What is fetched earlier may be out of the cache before it is used.
  static constexpr long most_lead = 20 * lead;
  static constexpr long most_ratio = 4; ///< of the lengths of two tasks, one of which fetches
  static constexpr long least_own_packs = lead + lead / 2; ///< of a row that its reader fetches
  void put(std::size_t task, const char* row, std::size_t bytes);

  const std::vector<long> tasks_;
  const std::size_t shares_;
  std::vector<long> start_; ///< packs before each task
  std::vector<Fetch> fetches_;
};

} // namespace dss
