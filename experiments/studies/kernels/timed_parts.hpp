#pragma once
/// Pieces of work that are timed in turn, round by round, and figures made of their times.
#include "experiments/base/records.hpp"

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace dss {

/// Something that is timed in each round; ns is of an element and pass.
struct Timed {
  std::function<void()> pass;
  double elements; ///< a pass
  long passes = 1;
  std::vector<double> ns{};
  std::vector<std::string> time_utc{};
};

/// All that is timed, by name.
using TimedParts = std::map<std::string, Timed>;
/// Times all parts in each round.
/// @param sample_s  shortest time of a part in a round [s]; so many passes are made
void time_rounds(TimedParts& parts, int rounds, double sample_s);

/// Times of one round, by name; NaN for what was not timed.
using RoundTimes = std::function<double(const std::string& name)>;
/// A figure made from the times of a round.
using Figure = std::function<double(const RoundTimes&)>;

/// Median of a figure over the rounds; NaN for what was not timed.
double over_rounds(const TimedParts& parts, const Figure& figure);
/// The median with its interval, in columns NAME, NAME_low and NAME_high.
void put_figure(Record& row, const std::string& column, const TimedParts& parts,
                const Figure& figure);

} // namespace dss
