#include "experiments/studies/study.hpp"

#include <algorithm>

namespace dss {

bool has_failed_rows(const Table& table) {
  return std::ranges::any_of(table.rows,
                             [](const Record& row) { return text_in(row, "status") == "failed"; });
}

StudyResult result_of(const std::string& name, Table table, const std::string& text) {
  const bool is_fine = !has_failed_rows(table);
  return {{{name, std::move(table)}}, text, is_fine};
}

} // namespace dss
