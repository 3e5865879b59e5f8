#include "experiments/runner/nearest.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <numeric>

namespace dss {
namespace {

/// Levenshtein's distance.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t(0));
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

} // namespace

std::string nearest(const std::string& unknown, const std::vector<std::string>& known) {
  std::string best;
  std::size_t least = std::max<std::size_t>(2, unknown.size() / 3) + 1;
  for (const std::string& name : known)
    if (const std::size_t distance = edit_distance(unknown, name); distance < least) {
      least = distance;
      best = name;
    }
  return best;
}

std::string suggestion(const std::string& unknown, const std::vector<std::string>& known) {
  const std::string best = nearest(unknown, known);
  if (!best.empty()) return fmt::format("did you mean \"{}\"?", best);
  return fmt::format("known: {}", fmt::join(known, ", "));
}

} // namespace dss
