#include "experiments/runner/cell_record.hpp"
#include "experiments/runner/context.hpp"
#include "experiments/runner/device_columns.hpp"
#include "experiments/runner/samples.hpp"

#include <fmt/format.h>

namespace dss {
namespace {

Record identity(const RecordPlace& place) {
  const Cell& cell = place.cell;
  Record row = {{"experiment", place.study.name},
                {"scale", place.study.scale.name},
                {"cell", cell.key()},
                {"scene", cell.scene},
                {"set", cell.set_text()},
                {"variant", cell.variant},
                {"model", cell.model},
                {"precision", cell.precision},
                {"integrator", cell.integrator},
                {"time_utc", measurement_time()}};
  row["device"] = cell.device;
  row["hybrid"] = cell.hybrid;
  row["twin"] = cell.is_twin ? "true" : "false";
  row["threads"] = fmt::format("{}", cell.threads);
  row["ranks"] = fmt::format("{}", cell.ranks);
  row["decomposition"] = cell.ranks > 1 ? cell.decomposition : "";
  row["halo"] = cell.ranks > 1 ? cell.halo : ""; // the strategy that ran is in halo_used
  row["cores"] = fmt::format("{}", place.cores);
  row["steps"] = fmt::format("{}", cell.steps);
  row["full_steps"] = fmt::format("{}", cell.full_steps);
  if (cell.rtol > 0) row["rtol"] = fmt::format("{}", cell.rtol);
  row["repetition"] = fmt::format("{}", place.repetition);
  row["attempt"] = fmt::format("{}", place.attempt);
  return row;
}

} // namespace

std::vector<std::string> run_arguments(const Study& study, const Cell& cell, const std::string& oracle_file,
                                       long repetition) {
  const auto text = [](auto number) { return fmt::format("{}", number); };
  std::vector<std::string> line = {"dssbench",
                                   "run",
                                   cell.scene,
                                   "--variant",
                                   cell.variant,
                                   "--threads",
                                   text(cell.threads),
                                   "--model",
                                   cell.model,
                                   "--precision",
                                   cell.precision,
                                   "--integrator",
                                   cell.integrator,
                                   "--steps",
                                   text(cell.steps),
                                   "--warmup",
                                   text(study.scale.warmup_steps),
                                   "--json",
                                   "-"};
  line.insert(line.end(), {cell.is_of_precision() ? "--reference" : "--check-state", oracle_file});
  if (cell.is_of_precision()) line.insert(line.end(), {"--repeat-for", text(study.scale.repeat_for)});
  if (cell.step_limit > 0) line.insert(line.end(), {"--stability-limit", text(cell.step_limit)});
  if (cell.dt > 0) line.insert(line.end(), {"--dt", text(cell.dt)});
  if (cell.rtol > 0) line.insert(line.end(), {"--rtol", text(cell.rtol)});
  if (cell.ranks > 1)
    line.insert(line.end(), {"--ranks", text(cell.ranks), "--decomposition", cell.decomposition, "--halo", cell.halo});
  if (!cell.hybrid.empty())
    line.insert(line.end(), {"--hybrid", cell.hybrid});
  else if (!cell.device.empty())
    line.insert(line.end(), {"--device", cell.device});
  if (study.scale.tail_checks > 0 && repetition >= study.scale.tail_checks)
    line.insert(line.end(), {"--check-tail", "0"});
  for (const Override& item : cell.set) line.insert(line.end(), {"--set", item.key + "=" + item.value});
  return line;
}

Record failure_record(const RecordPlace& place, const std::string& status, const std::string& reason) {
  Record row = identity(place);
  row["status"] = status;
  row["reason"] = reason;
  return row;
}

Record result_record(const RecordPlace& place, const nlohmann::json& json, double process_s) {
  Record row = identity(place);
  for (const std::string& column : raw_columns()) {
    if (row.contains(column) || !json.contains(column)) continue;
    const nlohmann::json& value = json[column];
    if (value.is_number_float())
      row[column] = number_text(value.get<double>());
    else if (value.is_string())
      row[column] = value.get<std::string>();
    else if (!value.is_null())
      row[column] = value.dump();
  }
  put_device_record(json, row);
  row["halo_used"] = json.value("halo", "");
  if (place.cell.rtol > 0) row["accepted_steps"] = json.contains("steps") ? json["steps"].dump() : "";
  row["contaminated"] = json.value("is_contaminated", false) ? "true" : "false";
  row["process_s"] = number_text(process_s);
  // JSON has no infinity: an error that is missing from a failed check is one
  if (json.value("check", "") == "failed" && row["check_error"].empty()) row["check_error"] = "inf";
  return row;
}

} // namespace dss
