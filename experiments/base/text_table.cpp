#include "experiments/base/text_table.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

bool is_numeric(const std::string& text) {
  return text.find_first_not_of("0123456789+-.e%±x ") == std::string::npos;
}

/// Counts characters, not bytes: UTF-8 continuation bytes have no width.
std::size_t width_of(const std::string& text) {
  return std::size_t(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u;
  }));
}

} // namespace

std::string text_table(const std::vector<std::string>& head,
                       const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  std::vector<bool> numeric;
  for (std::size_t c = 0; c < head.size(); ++c) {
    std::size_t width = width_of(head[c]);
    for (const auto& row : rows) width = std::max(width, width_of(row[c]));
    widths.push_back(width);
    numeric.push_back(
        std::all_of(rows.begin(), rows.end(), [c](const auto& row) { return is_numeric(row[c]); }));
  }
  std::string text;
  const auto add_line = [&](const std::vector<std::string>& cells) {
    std::string line;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const std::string gap(widths[c] - width_of(cells[c]), ' ');
      line += (c > 0 ? "  " : "") + (numeric[c] ? gap + cells[c] : cells[c] + gap);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  };
  add_line(head);
  for (const auto& row : rows) add_line(row);
  return text;
}

} // namespace dss
