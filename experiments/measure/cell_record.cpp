#include "experiments/measure/cell_record.hpp"
#include "experiments/measure/cell_bases.hpp"
#include "experiments/run/plan/context.hpp"
#include "experiments/run/timed/run_fields.hpp"
#include "solver/cores.hpp"

#include <fmt/format.h>

namespace dss {
namespace {

/// A column that describes the cell and the repetition: one line is one column.
struct CellField {
  const char* column;
  const char* meaning;
  std::string (*value)(const RecordPlace& at);
  bool is_in_tables = true;
};

template <class Number>
std::string text(Number number) {
  return fmt::format("{}", number);
}

using At = const RecordPlace&;
const CellField cell_fields[] = {
    {"experiment", "the study", [](At at) { return at.study.name; }},
    {"scale", "scale of the study", [](At at) { return at.study.scale.name; }},
    {"cell", "everything that makes two rows comparable, in one text; (A/A): second of equal cells",
     [](At at) { return at.cell.key(); }, false},
    {"scene", "the scene", [](At at) { return at.cell.scene; }},
    {"set", "its overrides", [](At at) { return at.cell.set_text(); }},
    {"variant", "variant, of ranks that of their parts", [](At at) { return at.cell.variant; }},
    {"model", "model", [](At at) { return at.cell.model; }},
    {"precision", "precision", [](At at) { return at.cell.precision; }},
    {"integrator", "method", [](At at) { return at.cell.integrator; }},
    {"threads", "threads of each rank", [](At at) { return text(at.cell.threads); }},
    {"ranks", "processes", [](At at) { return text(at.cell.ranks); }},
    {"decomposition", "method of decomposition, on several ranks",
     [](At at) { return at.cell.ranks > 1 ? at.cell.decomposition : ""; }},
    {"halo", "halo strategy asked for, on several ranks",
     [](At at) { return at.cell.ranks > 1 ? at.cell.halo : ""; }},
    {"device", "device asked for", [](At at) { return at.cell.device; }},
    {"hybrid", "members asked for", [](At at) { return at.cell.hybrid; }},
    {"twin", "second of an A/A pair: one cell measured as if it were two",
     [](At at) { return std::string(at.cell.is_twin ? "true" : "false"); }, false},
    {"cores", "cores that the study may use", [](At at) { return text(at.cores); }},
    {"steps", "steps asked for", [](At at) { return text(at.cell.steps); }},
    {"full_steps", "steps that times are scaled to, for variants too slow to run them all",
     [](At at) { return text(at.cell.full_steps); }, false},
    {"rtol", "relative tolerance of adaptive steps",
     [](At at) { return at.cell.rtol > 0 ? text(at.cell.rtol) : std::string(); }, false},
    {"repetition", "number of the round", [](At at) { return text(at.repetition); }, false},
    {"attempt", "number of the retry; the last attempt counts",
     [](At at) { return text(at.attempt); }, false},
    {"time_utc", "when it ended", [](At) { return measurement_time(); }, false},
};

/// A column that is measured outside the run.
struct FurtherColumn {
  const char *column, *unit, *meaning;
};
constexpr FurtherColumn further_columns[] = {
    {"triad_bytes_per_s", "B/s", "memory bandwidth of the device"},
    {"peak_flops_per_s", "1/s", "fused multiply-adds of the device, two flops each"},
    {"process_s", "s", "wall time of the whole process"}};

const char* name_of(Aggregate aggregate) {
  constexpr const char* names[] = {"", "last", "median", "largest", "all different"};
  return names[std::size_t(aggregate)];
}

Record identity(const RecordPlace& at) {
  Record row;
  for (const CellField& field : cell_fields) row[field.column] = field.value(at);
  return row;
}

std::string column_text(const nlohmann::json& value) {
  if (value.is_number_float()) return number_text(value.get<double>());
  if (value.is_string()) return value.get<std::string>();
  return value.is_null() ? "" : value.dump();
}

} // namespace

const std::vector<std::string>& raw_columns() {
  static const std::vector<std::string> columns = [] {
    std::vector<std::string> all;
    for (const CellField& field : cell_fields) all.emplace_back(field.column);
    for (const RunField& field : run_fields())
      if (*field.column != '\0') all.emplace_back(field.column);
    for (const FurtherColumn& further : further_columns) all.emplace_back(further.column);
    return all;
  }();
  return columns;
}

std::vector<ColumnMeaning> column_meanings() {
  std::vector<ColumnMeaning> all;
  for (const CellField& field : cell_fields)
    all.push_back({"", field.column, field.is_in_tables ? "of the cell" : "", "", field.meaning});
  for (const RunField& field : run_fields())
    all.push_back({field.key, field.column, name_of(field.in_tables), field.unit, field.meaning});
  for (const FurtherColumn& further : further_columns)
    all.push_back({"", further.column, "", further.unit, further.meaning});
  return all;
}

std::vector<std::string> identity_columns() {
  std::vector<std::string> columns{"source", "label"};
  for (const CellField& field : cell_fields)
    if (field.is_in_tables) columns.emplace_back(field.column);
  return columns;
}

void put_identity(const RecordPlace& place, Record& row) {
  row["source"] = "measured";
  row["label"] = place.cell.label();
  for (const CellField& field : cell_fields)
    if (field.is_in_tables) row[field.column] = field.value(place);
}

/// Cells that others are compared with take twice as many samples: every speed-up depends on them.
static long sample_count(const CellStudy& study, const Cell& cell) {
  const long samples = study.scale.samples;
  if (samples == 1 || !cell.is_compared(usable_cores())) return 1;
  return is_partner(study, cell) ? 2 * samples : samples;
}

std::vector<std::string> run_arguments(const CellStudy& study, const Cell& cell,
                                       const std::vector<std::string>& checks) {
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
                                   "--warmup-time",
                                   text(study.scale.warmup_s),
                                   "--samples",
                                   text(sample_count(study, cell)),
                                   "--json",
                                   "-"};
  line.insert(line.end(), checks.begin(), checks.end());
  if (cell.members > 1) line.insert(line.end(), {"--ensemble", text(cell.members)});
  if (cell.dt > 0) line.insert(line.end(), {"--dt", text(cell.dt)});
  if (cell.rtol > 0) line.insert(line.end(), {"--rtol", text(cell.rtol)});
  if (cell.ranks > 1)
    line.insert(line.end(), {"--ranks", text(cell.ranks), "--decomposition", cell.decomposition,
                             "--halo", cell.halo});
  if (!cell.hybrid.empty())
    line.insert(line.end(), {"--hybrid", cell.hybrid});
  else if (!cell.device.empty())
    line.insert(line.end(), {"--device", cell.device});
  for (const Override& item : cell.set)
    line.insert(line.end(), {"--set", item.key + "=" + item.value});
  return line;
}

Record failure_record(const RecordPlace& place, const std::string& status,
                      const std::string& reason) {
  Record row = identity(place);
  row["status"] = status;
  row["reason"] = reason;
  return row;
}

Record result_record(const RecordPlace& place, const nlohmann::json& json, double process_s) {
  Record row = identity(place);
  for (const RunField& field : run_fields())
    if (*field.column != '\0' && json.contains(field.key))
      row[field.column] = column_text(json[field.key]);
  row["process_s"] = number_text(process_s);
  // JSON has no infinity: if a failed check has no error, the error was infinite.
  if (json.value("check", "") == "failed" && row["check_error"].empty()) row["check_error"] = "inf";
  return row;
}

} // namespace dss
