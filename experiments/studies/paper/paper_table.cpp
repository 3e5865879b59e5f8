#include "experiments/base/text_table.hpp"
#include "experiments/studies/paper/paper_study.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fnmatch.h>

namespace dss {
namespace {

const std::vector<std::string>& paper_columns() {
  static const std::vector<std::string> columns = {"experiment",
                                                   "scale",
                                                   "row",
                                                   "column",
                                                   "way",
                                                   "base",
                                                   "unit",
                                                   "paper",
                                                   "measured",
                                                   "measured_low",
                                                   "measured_high",
                                                   "ran",
                                                   "machine",
                                                   "set",
                                                   "steps",
                                                   "scaled",
                                                   "repetitions",
                                                   "contaminated",
                                                   "simulated_paper_node",
                                                   "simulated_own_node",
                                                   "status"};
  return columns;
}

Where joined(Where where, const Where& more) {
  for (const auto& [column, text] : more) where[column] = text;
  return where;
}

/// True if the row of a table has these texts. One process exchanges nothing: its halo is empty.
bool fits(const Record& row, const Where& where) {
  return std::ranges::all_of(where, [&](const auto& condition) {
    const auto& [column, expected] = condition;
    const std::string text = text_in(row, column);
    if (column == "threads" && expected == "fill")
      return number_in(row, "threads") ==
             std::max(1.0, std::floor(number_in(row, "cores") / number_in(row, "ranks")));
    return ::fnmatch(expected.c_str(), text.c_str(), 0) == 0 || (column == "halo" && text.empty());
  });
}

/// True for a cell of the paper's computation: its model, precision and method, and no second cell
/// of an A/A pair.
bool is_the_papers(const Record& row) {
  return text_in(row, "source") == "measured" && !text_in(row, "label").ends_with("(A/A)") &&
         fits(row, {{"model", "spatial"}, {"precision", "f64"}, {"integrator", "rk4"}});
}

/// Time of the paper's steps [s], measured or scaled; NaN without a time.
double time_in(const Record& row, double steps, const char* end = "") {
  return number_in(row, fmt::format("measured_wall{}_s", end)) * steps / number_in(row, "steps");
}

/// The fastest row that is right and fits; else the first that fits, for its status. Null if none
/// fits.
const Record* chosen(const Table& table, const Where& where) {
  const Record* best = nullptr;
  for (const Record& row : table.rows) {
    if (!is_the_papers(row) || !fits(row, where)) continue;
    const bool is_right = text_in(row, "status") == "ok";
    const bool is_better =
        best == nullptr ||
        (is_right && (text_in(*best, "status") != "ok" || time_in(row, 1) < time_in(*best, 1)));
    if (is_better) best = &row;
  }
  return best;
}

std::string status_of(const Record& row) {
  const std::string status = text_in(row, "status"), reason = text_in(row, "reason");
  return reason.empty() ? status : status + ": " + reason;
}

/// What ran, on which machine, and how it was measured.
void put_run(const Record& from, const std::string& machine, double steps, Record& row) {
  row["ran"] = text_in(from, "label");
  row["machine"] = machine;
  row["set"] = text_in(from, "set");
  row["steps"] = text_in(from, "steps");
  row["scaled"] = number_in(from, "steps") < steps ? "yes" : "no";
  row["repetitions"] = text_in(from, "repetitions");
  row["contaminated"] = text_in(from, "contaminated");
  row["status"] = status_of(from);
}

/// Without an interval, no figure.
void put_interval(double median, double low, double high, Record& row) {
  if (std::isnan(low) || std::isnan(high)) return;
  row["measured"] = number_text(median);
  row["measured_low"] = number_text(low);
  row["measured_high"] = number_text(high);
}

void put_time(const Record& from, double steps, Record& row) {
  put_interval(time_in(from, steps), time_in(from, steps, "_low"), time_in(from, steps, "_high"),
               row);
}

void put_speedup(const Record& from, const std::string& base, Record& row) {
  for (const char* form : {"speedup_vs_", "extrapolated_speedup_vs_"}) {
    const std::string column = form + base;
    if (!std::isnan(number_in(from, column)))
      put_interval(number_in(from, column), number_in(from, column + "_low"),
                   number_in(from, column + "_high"), row);
  }
}

class PaperTable {
public:
  PaperTable(const PaperStudy& study, const PaperSources& sources)
      : study_(study), sources_(sources) {}

  Table made() const {
    Table table{paper_columns(), {}};
    for (const PaperLine& row : study_.rows)
      for (const PaperCell& cell : row.cells)
        for (Record& record : records_of(row, cell)) table.rows.push_back(std::move(record));
    return table;
  }

private:
  std::vector<Record> records_of(const PaperLine& row, const PaperCell& cell) const {
    std::vector<Record> records;
    if (cell.is_base)
      for (const std::string& base : study_.bases)
        records.push_back(time_of(row, cell, {"the base", {{"variant", base}}, {}}, base));
    else
      for (const PaperWay& way : row.ways)
        if (cell.speedup_of.empty())
          records.push_back(time_of(row, cell, way, ""));
        else
          for (const std::string& base : study_.bases)
            records.push_back(speedup_of(row, cell, way, base));
    return records;
  }

  Record head(const PaperLine& row, const PaperCell& cell, const PaperWay& way,
              const std::string& base, const char* unit) const {
    return {{"experiment", study_.name},
            {"scale", study_.scale},
            {"row", row.name},
            {"column", cell.column},
            {"way", way.name},
            {"base", base},
            {"unit", unit},
            {"paper", number_text(cell.paper)}};
  }

  /// Puts what ran. Returns its row, or null if nothing was measured.
  const Record* put_measured(const Where& where, Record& record) const {
    const Record* here = chosen(sources_.measured, where);
    const Record* there = chosen(sources_.elsewhere, where);
    const auto is_right = [](const Record* row) {
      return row != nullptr && text_in(*row, "status") == "ok";
    };
    const bool is_elsewhere = !is_right(here) && is_right(there);
    const Record* from = is_elsewhere ? there : here;
    if (from == nullptr) {
      record["status"] = fmt::format("not measured at scale {}", study_.scale);
      return nullptr;
    }
    put_run(*from, is_elsewhere ? sources_.machine_elsewhere : sources_.machine, study_.steps,
            record);
    return is_right(from) ? from : nullptr;
  }

  Record time_of(const PaperLine& row, const PaperCell& cell, const PaperWay& way,
                 const std::string& base) const {
    Record record = head(row, cell, way, base, "s");
    if (const Record* from = put_measured(joined(cell.where, way.measured), record))
      put_time(*from, study_.steps, record);
    if (const Record* run = simulated(cell, way))
      for (const char* node : {"paper_node", "own_node"})
        record[fmt::format("simulated_{}", node)] =
            number_text(number_in(*run, fmt::format("simulated_{}_wall_s", node)) * study_.steps /
                        number_in(*run, "steps"));
    return record;
  }

  Record speedup_of(const PaperLine& row, const PaperCell& cell, const PaperWay& way,
                    const std::string& base) const {
    Record record = head(row, cell, way, base, "ratio");
    if (const Record* from = put_measured(joined(cell.where, way.measured), record))
      put_speedup(*from, base, record);
    const Record* run = simulated(cell, way);
    const auto published = std::ranges::find(row.cells, true, &PaperCell::is_base);
    if (run != nullptr && published != row.cells.end())
      record["simulated_paper_node"] =
          number_text(published->paper / (number_in(*run, "simulated_paper_node_wall_s") *
                                          study_.steps / number_in(*run, "steps")));
    return record;
  }

  const Record* simulated(const PaperCell& cell, const PaperWay& way) const {
    const auto ranks = cell.where.find("ranks");
    if (ranks == cell.where.end() || way.simulated.empty()) return nullptr;
    Where where = joined(study_.simulated_where, way.simulated);
    where["ranks"] = ranks->second;
    const auto run = std::ranges::find_if(sources_.simulated.rows, [&](const Record& row) {
      return text_in(row, "status") == "ok" && fits(row, where);
    });
    return run == sources_.simulated.rows.end() ? nullptr : &*run;
  }

  const PaperStudy& study_;
  const PaperSources& sources_;
};

} // namespace

Table paper_table(const PaperStudy& study, const PaperSources& sources) {
  return PaperTable(study, sources).made();
}

Table paper_figure(const PaperStudy& study, const Table& table) {
  Table figure{{"experiment", "scale", "curve", "set", "way", "paper_s", "measured_s",
                "measured_low_s", "measured_high_s", "ran", "machine", "scaled", "status"},
               {}};
  for (const Record& row : table.rows)
    if (text_in(row, "unit") == "s")
      figure.rows.push_back({{"experiment", study.figure},
                             {"scale", study.scale},
                             {"curve", text_in(row, "row")},
                             {"set", text_in(row, "column")},
                             {"way", text_in(row, "way")},
                             {"paper_s", text_in(row, "paper")},
                             {"measured_s", text_in(row, "measured")},
                             {"measured_low_s", text_in(row, "measured_low")},
                             {"measured_high_s", text_in(row, "measured_high")},
                             {"ran", text_in(row, "ran")},
                             {"machine", text_in(row, "machine")},
                             {"scaled", text_in(row, "scaled")},
                             {"status", text_in(row, "status")}});
  return figure;
}

std::string paper_text(const PaperStudy& study, const Table& table) {
  std::vector<std::vector<std::string>> rows;
  for (const Record& row : table.rows) {
    const std::string measured = shown(row, "measured", "{:.4g}");
    rows.push_back(
        {text_in(row, "row"), text_in(row, "column"), text_in(row, "way"), text_in(row, "base"),
         text_in(row, "paper"),
         measured.empty() ? ""
                          : fmt::format("{}{} [{}, {}]", text_in(row, "scaled") == "yes" ? "~" : "",
                                        measured, shown(row, "measured_low", "{:.4g}"),
                                        shown(row, "measured_high", "{:.4g}")),
         shown(row, "simulated_paper_node", "{:.4g}"), shown(row, "simulated_own_node", "{:.4g}"),
         text_in(row, "ran"), text_in(row, "status")});
  }
  return fmt::format("{} ({}, scale {})\n{}\n{}~ scaled from fewer steps; [95 % interval].\n",
                     study.title, study.name, study.scale, study.source,
                     text_table({"row", "column", "way", "base", "paper", "measured",
                                 "simulated, paper's node", "simulated, own node", "ran", "status"},
                                rows));
}

} // namespace dss
