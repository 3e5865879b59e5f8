#include "experiments/base/text_table.hpp"
#include "experiments/studies/speedup/speedup_table.hpp"

#include <cmath>
#include <fmt/format.h>

namespace dss {
namespace {

/// Overrides, and the precision where it is not the usual one.
std::string shown_set(const Record& row) {
  const std::string precision = text_in(row, "precision");
  return text_in(row, "set") + (precision.empty() || precision == "f64" ? "" : " " + precision);
}

/// A median with its interval.
std::string shown_interval(const Record& row, const std::string& column) {
  if (text_in(row, column + "_low").empty()) return shown(row, column, "{:.2f}");
  return fmt::format("{} [{}, {}]", shown(row, column, "{:.2f}"),
                     shown(row, column + "_low", "{:.2f}"), shown(row, column + "_high", "{:.2f}"));
}

std::string shown_speedup(const Record& row, const std::string& base) {
  const std::string measured = "speedup_vs_" + base, scaled = "extrapolated_" + measured;
  if (!text_in(row, measured).empty()) return shown_interval(row, measured);
  return text_in(row, scaled).empty() ? "" : fmt::format("~{}", shown_interval(row, scaled));
}

std::string shown_time(const Record& row) {
  const double half = number_in(row, "half_width");
  const std::string time = shown(row, "measured_wall_s", "{:.4g}");
  return std::isnan(half) ? time : fmt::format("{} ± {:.1f} %", time, 100 * half);
}

std::string shown_status(const Record& row) {
  const std::string status = text_in(row, "status"), reason = text_in(row, "reason");
  if (!reason.empty()) return status + ": " + reason;
  const bool is_ok = status == "ok";
  return status + (is_ok && text_in(row, "converged") == "no" ? ", not converged" : "") +
         (is_ok && number_in(row, "short") > 0 ? ", short samples" : "") +
         (is_ok && number_in(row, "contaminated") > 0
              ? fmt::format(", {} of {} contaminated", text_in(row, "contaminated"),
                            text_in(row, "repetitions"))
              : "");
}

/// Cells with `auto` whose time is not that of the strategy that it chose, although both ran the
/// same: the difference is noise that the A/A pair did not show. Empty if there are none.
std::string inconsistency_text(const Table& table) {
  std::string text;
  for (const Record& row : table.rows) {
    const double low = number_in(row, "auto_vs_chosen_low"),
                 high = number_in(row, "auto_vs_chosen_high"),
                 resolution = number_in(row, "resolution");
    if (low > 1 + resolution || high < 1 - resolution)
      text +=
          fmt::format("Inconsistent: {} {} ran as {}, and that alone takes {} times its time.\n",
                      text_in(row, "label"), shown_set(row), text_in(row, "halo_used"),
                      shown_interval(row, "auto_vs_chosen"));
  }
  return text;
}

/// What the cells on several ranks cost and gain; empty if there are none.
std::string scaling_text(const Table& table) {
  std::vector<std::vector<std::string>> rows;
  for (const Record& row : table.rows)
    if (text_in(row, "source") == "measured" && number_in(row, "ranks") > 1)
      rows.push_back(
          {text_in(row, "label"), shown_set(row), text_in(row, "halo_used"),
           shown_interval(row, "speedup_vs_1_rank"), shown(row, "parallel_efficiency", "{:.2f}"),
           shown(row, "karp_flatt", "{:.3f}"), shown_interval(row, "speedup_vs_threads"),
           shown_interval(row, "weak_efficiency"),
           shown(row, "communication_share", "{:.1f} %", 100),
           shown(row, "messages_per_step", "{:.4g}"), shown(row, "bytes_per_step", "{:.4g}", 1e-3),
           shown(row, "imbalance", "{:.3f}"), text_in(row, "status")});
  if (rows.empty()) return "";
  return fmt::format("\nOver ranks:\n{}"
                     "vs 1 rank, efficiency, Karp-Flatt: the same problem; vs threads: one process "
                     "with as many threads "
                     "as all ranks; weak: the problem grows with the ranks.\n",
                     text_table({"cell", "set", "halo used", "vs 1 rank", "efficiency",
                                 "Karp-Flatt", "vs threads", "weak efficiency", "exchanges",
                                 "messages/step", "kB/step", "imbalance", "status"},
                                rows));
}

/// Transfers, launches and what they cost; members of hybrids and what joining gains; empty if no
/// cell has a device or members.
std::string device_text(const Table& table) {
  std::vector<std::vector<std::string>> devices, hybrids;
  for (const Record& row : table.rows) {
    if (text_in(row, "measured_wall_s").empty() || text_in(row, "label").ends_with("(A/A)"))
      continue;
    if (!text_in(row, "hybrid").empty())
      hybrids.push_back({text_in(row, "label"), shown_set(row), text_in(row, "members"),
                         shown(row, "rebalances", "{:g}"),
                         shown(row, "of_sum_of_members", "{:.3f}"), text_in(row, "fastest_alone"),
                         shown_interval(row, "speedup_vs_fastest_alone")});
    else if (!text_in(row, "device_used").empty())
      devices.push_back(
          {text_in(row, "label"), shown_set(row), shown(row, "launches_per_step", "{:.3g}"),
           shown(row, "launch_us", "{:.3g}"),
           shown(row, "to_device_bytes_per_step", "{:.4g}", 1e-3),
           shown(row, "from_device_bytes_per_step", "{:.4g}", 1e-3),
           shown(row, "transfer_us_per_step", "{:.3g}"), shown(row, "first_step_s", "{:.3g}"),
           shown(row, "build_s", "{:.3g}"), shown_interval(row, "speedup_vs_resident"),
           shown(row, "bandwidth_share", "{:.1f} %", 100),
           shown(row, "peak_share", "{:.1f} %", 100)});
  }
  std::string text;
  if (!devices.empty())
    text +=
        "\nOn devices:\n" + text_table({"cell", "set", "launches/step", "launch [us]", "kB/step to",
                                        "kB/step from", "transfers [us/step]", "first step [s]",
                                        "build [s]", "vs resident", "of bandwidth", "of peak"},
                                       devices);
  if (!hybrids.empty())
    text += "\nHybrids:\n" + text_table({"cell", "set", "members and shares", "re-balanced",
                                         "of members' sum", "fastest alone", "vs fastest alone"},
                                        hybrids);
  return text;
}

} // namespace

std::string table_text(const SpeedupStudy& study, const Table& table) {
  std::vector<std::string> head = {
      "cell", "set", "steps", "n", "wall [s]", "extrapolated [s]", "Melement-steps/s"};
  for (const std::string& base : study.bases) head.push_back("speed-up vs " + base);
  head.insert(head.end(), {"error", "status"});
  std::vector<std::vector<std::string>> rows, paper;
  std::string resolution;
  for (const Record& row : table.rows) {
    if (text_in(row, "source") == "paper") {
      paper.push_back({text_in(row, "label"), shown_set(row), shown(row, "paper_wall_s", "{:.2f}"),
                       shown(row, "paper_speedup", "{:.2f}")});
      continue;
    }
    rows.push_back({text_in(row, "label"), shown_set(row), text_in(row, "steps"),
                    text_in(row, "repetitions"), shown_time(row),
                    shown(row, "extrapolated_wall_s", "{:.4g}"),
                    shown(row, "element_steps_per_s", "{:.2f}", 1e-6)});
    for (const std::string& base : study.bases) rows.back().push_back(shown_speedup(row, base));
    rows.back().push_back(shown(row, "check_error", "{:.1e}"));
    rows.back().push_back(shown_status(row));
    resolution = shown(row, "resolution", "{:.1f} %", 100);
  }
  std::string text = fmt::format("{} ({}, scale {})\n{}", study.title, study.name, study.scale.name,
                                 text_table(head, rows));
  text += "Medians with the half-width of their 95 % interval; speed-ups are medians of ratios of "
          "interleaved pairs "
          "[95 % interval]; ~ scaled from fewer steps.\n";
  if (!resolution.empty())
    text += fmt::format("Resolution by the A/A pair: {}. No claim below it.\n", resolution);
  text += inconsistency_text(table) + scaling_text(table) + device_text(table);
  if (!paper.empty())
    text += fmt::format("\nPublished ({}):\n{}", study.paper_source,
                        text_table({"configuration", "set", "wall [s]", "speed-up"}, paper));
  return text;
}

} // namespace dss
