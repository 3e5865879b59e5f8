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

/// Rows that tasks are the first to read, and the tasks that fetch them: each at most one row, a
/// part along with each of its packs.
class FetchPlan {
public:
  struct Task {
    int packs; ///< 0: the task cannot fetch
    int sweep;
  };
  /// @param tasks  in their order
  explicit FetchPlan(std::vector<Task> tasks);
  /// Tells that a task is the first to read a row since it left the cache. Tasks must come in
  /// ascending order. An earlier task of the same sweep fetches the row, since the sweep that reads
  /// the state has the least to load; if there is none, one of another sweep. A long row is fetched
  /// by its reader, ahead of its own reading; what is then missing at its start, the row before it
  /// in memory has fetched beyond its end.
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
  static constexpr long least_own_packs = lead + lead / 2; ///< of a row that its reader fetches
  void put(std::size_t task, const char* row, std::size_t bytes);

  const std::vector<Task> tasks_;
  std::vector<long> start_; ///< packs before each task
  std::vector<Fetch> fetches_;
};

} // namespace dss
