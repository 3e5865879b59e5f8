#pragma once
/// Decides from the members' own times of steps whether their shares of the elements fit. It reads
/// no clock itself, so that tests can give it times.
#include <cstddef>
#include <deque>
#include <span>
#include <vector>

namespace dss {

/// The middle value, or the mean of the two in the middle; 0 if there is none.
double median(std::vector<double> values);

/// Speed of each part [elements/s].
/// @param elements  elements of each part
/// @param step_s    time of a step of each part [s]
std::vector<double> speeds(std::span<const std::size_t> elements, std::span<const double> step_s);

/// Time of a step of the slowest part [s].
/// @param elements  elements of each part
/// @param speed     speed of each part [elements/s]
double slowest_step_s(std::span<const std::size_t> elements, std::span<const double> speed);

/// Collects times of blocks of steps, and decides when elements should move.
class Balance {
public:
  /// Tolerated difference, as a fraction of the slowest member's step.
  static constexpr double tolerated = 0.05;
  static constexpr double worthwhile = 0.02; ///< fraction of a step that a move must save
  static constexpr long least_steps = 10;    ///< shortest block [steps]

  /// Duration of a block [s]. Each move doubles it (up to 64 times), so that noise cannot make
  /// elements move for ever.
  double block_s() const;
  /// Adds a block: each member's median time of a step [s].
  void add(std::vector<double> step_s);
  /// Whether the members' times differ by more than `tolerated` in each of the last blocks_needed
  /// blocks, with the same slowest member.
  bool is_uneven() const;
  /// Each member's mean over these blocks [s].
  std::vector<double> step_s() const;
  /// Call it after elements have moved.
  void moved();
  /// Whether a move pays.
  /// @param now_s     present time of a step [s]
  /// @param gain_s    time that the move saves in a step [s]
  /// @param steps     steps to come
  /// @param moving_s  time of the move [s]
  static bool pays(double now_s, double gain_s, double steps, double moving_s);

private:
  static constexpr std::size_t blocks_needed = 3;
  /// The last blocks_needed blocks: each member's time of a step [s].
  std::deque<std::vector<double>> blocks_;
  int moves_ = 0;
};

} // namespace dss
