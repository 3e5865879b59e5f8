#include "experiments/studies/kernels/micro_tables.hpp"
#include "experiments/base/statistics.hpp"
#include "experiments/base/text_table.hpp"
#include "experiments/measure/samples.hpp"
#include "variants/isa/instruction_set.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace dss {
namespace {

const std::vector<std::string> kept_columns = {"cell",
                                               "kernel",
                                               "model",
                                               "precision",
                                               "variant",
                                               "isa",
                                               "level",
                                               "n",
                                               "working_set_bytes",
                                               "threads",
                                               "flops_per_element",
                                               "bytes_per_element"};

/// The instruction set of a module in the words of the ceilings; empty where none is measured.
/// @param march  what the module says of itself
std::string isa_of_ceiling(const std::string& march) {
  if (march.starts_with("OpenCL")) return "opencl";
  for (const InstructionSet& isa : instruction_sets())
    if (isa.march == march) return isa.name;
  return "";
}

void put_rates(const Record& head, const std::vector<double>& ns,
               const std::vector<Ceiling>& ceilings, Record& row) {
  const Estimate time = estimate(ns);
  const double rate = 1e9 / time.median, flops = rate * number_in(head, "flops_per_element"),
               bytes = rate * number_in(head, "bytes_per_element");
  const int threads = int(number_in(head, "threads"));
  put_interval(row, "measured_ns_per_element", time);
  row["elements_per_s"] = number_text(rate);
  row["flops_per_s"] = number_text(flops);
  row["bytes_per_s"] = number_text(bytes);
  const double intensity =
      number_in(head, "flops_per_element") / number_in(head, "bytes_per_element");
  row["intensity_flop_per_byte"] = number_text(intensity);
  const double peak = peak_flops(ceilings, isa_of_ceiling(text_in(head, "isa")),
                                 text_in(head, "precision"), threads),
               stream = intensity * bandwidth(ceilings, text_in(head, "level"), threads);
  if (std::isnan(peak) || std::isnan(stream)) return;
  row["roof_flops_per_s"] = number_text(std::min(peak, stream));
  row["share_of_roof"] = number_text(flops / std::min(peak, stream));
  row["limiter"] = peak < stream ? "arithmetic" : text_in(head, "level") + " bandwidth";
}

} // namespace

Table kernel_table(const std::vector<Record>& records, const std::vector<Ceiling>& ceilings) {
  Table table{kept_columns, {}};
  for (const char* column :
       {"repetitions", "contaminated", "short", "measured_ns_per_element",
        "measured_ns_per_element_low", "measured_ns_per_element_high", "elements_per_s",
        "flops_per_s", "bytes_per_s", "intensity_flop_per_byte", "roof_flops_per_s",
        "share_of_roof", "limiter", "check", "check_error", "status", "reason"})
    table.columns.emplace_back(column);
  for (const CellSample& sample : samples_of(records)) {
    Record row;
    for (const std::string& column : kept_columns) row[column] = text_in(sample.last, column);
    row["repetitions"] = fmt::format("{}", sample.repetitions.size());
    row["contaminated"] = fmt::format("{}", sample.contaminated);
    row["short"] = fmt::format("{}", sample.too_short);
    row["check"] = sample.check();
    row["check_error"] = number_text(sample.check_error());
    row["status"] = sample.status();
    row["reason"] = sample.reason();
    std::vector<double> ns;
    for (const auto& [number, step_s] : sample.step_s())
      ns.push_back(1e9 * step_s / number_in(sample.last, "elements"));
    if (!ns.empty() && row["status"] == "ok")
      put_rates(sample.last, ns, ceilings, row);
    else if (!ns.empty())
      row["measured_ns_per_element"] = number_text(median(ns));
    table.rows.push_back(std::move(row));
  }
  std::ranges::sort(table.rows, {}, [](const Record& row) { return text_in(row, "cell"); });
  return table;
}

std::string kernel_text(const Table& table) {
  std::vector<std::vector<std::string>> rows;
  for (const Record& row : table.rows)
    rows.push_back(
        {text_in(row, "cell"), shown(row, "measured_ns_per_element", "{:.4g}"),
         shown(row, "flops_per_s", "{:.3g}", 1e-9), shown(row, "bytes_per_s", "{:.3g}", 1e-9),
         shown(row, "share_of_roof", "{:.2f}"), text_in(row, "limiter"),
         text_in(row, "status") == "ok" ? ""
                                        : text_in(row, "status") + ": " + text_in(row, "reason")});
  return text_table({"kernel/model/precision/variant/level/threads", "ns/element", "GFLOP/s",
                     "GB/s", "of its roof", "which is", ""},
                    rows);
}

} // namespace dss
