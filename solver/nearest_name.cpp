#include "solver/nearest_name.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <numeric>

namespace dss {

/// Levenshtein distance.
static std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t(0));
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t above = row[j + 1];
      row[j + 1] = std::min({above + 1, row[j] + 1, diagonal + (a[i] == b[j] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row.back();
}

std::string nearest_name(const std::string& name, const std::vector<std::string>& known) {
  const std::string list = fmt::format("known: {}", fmt::join(known, ", "));
  const auto suggest = [&](const std::string& one) {
    return fmt::format("did you mean \"{}\"? {}", one, list);
  };
  const auto whole = std::find_if(known.begin(), known.end(), [&](const std::string& one) {
    return name.size() > 1 && one.starts_with(name);
  });
  if (whole != known.end()) return suggest(*whole);
  const auto best =
      std::min_element(known.begin(), known.end(), [&](const std::string& a, const std::string& b) {
        return edit_distance(name, a) < edit_distance(name, b);
      });
  if (best == known.end() || edit_distance(name, *best) > std::max<std::size_t>(2, name.size() / 2))
    return list;
  return suggest(*best);
}

} // namespace dss
