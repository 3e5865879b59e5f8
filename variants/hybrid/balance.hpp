#pragma once
/// Whether members of a hybrid have the right shares, from their own times of steps. Knows no clock.
#include <cstddef>
#include <deque>
#include <span>
#include <vector>

namespace dss {

/// The middle one, or the mean of the two in the middle; 0 of none.
double median(std::vector<double> values);

/// Elements a second.
std::vector<double> speeds(std::span<const std::size_t> elements, std::span<const double> step_s);

/// Of all parts with these speeds: that of the slowest.
double slowest_step_s(std::span<const std::size_t> elements, std::span<const double> speed);

/// Evidence from blocks of steps.
class Balance {
public:
  static constexpr double tolerated = 0.05;  ///< of the slowest member's step
  static constexpr double worthwhile = 0.02; ///< what a move must save of a step
  static constexpr long least_steps = 10;    ///< of a block

  /// How long a block lasts [s]. Each move doubles it, so that noise cannot make elements move for ever.
  double block_s() const;
  /// Each member's median over a block [s].
  void add(std::vector<double> step_s);
  /// Whether members differ by more than is tolerated in each of the last blocks_needed blocks, with the same one the slowest.
  bool is_uneven() const;
  /// Each member's mean of these blocks [s].
  std::vector<double> step_s() const;
  /// Elements have moved.
  void moved();
  /// What saves gain_s a step of now_s for some steps more is worth moving_s.
  static bool pays(double now_s, double gain_s, double steps, double moving_s);

private:
  static constexpr std::size_t blocks_needed = 3;
  std::deque<std::vector<double>> blocks_; ///< the last ones
  int moves_ = 0;
};

} // namespace dss
