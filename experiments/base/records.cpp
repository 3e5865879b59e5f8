#include "experiments/base/records.hpp"
#include "solver/error.hpp"
#include "solver/io/atomic_file.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

namespace dss {
namespace {

std::string quoted(const std::string& value) {
  std::string flat = value;
  for (char& c : flat)
    if (c == '\n' || c == '\r') c = ' ';
  if (flat.find_first_of(",\"") == std::string::npos) return flat;
  std::string out = "\"";
  for (const char c : flat) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

std::string head_line(const std::vector<std::string>& columns) {
  return fmt::format("{}\n", fmt::join(columns, ","));
}

} // namespace

std::string number_text(double value) {
  return std::isnan(value) ? std::string() : fmt::format("{}", value);
}

double number_in(const Record& record, const std::string& column) {
  const std::string text = text_in(record, column);
  if (text.empty()) return std::nan("");
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw InputError(fmt::format("column {}: \"{}\" is not a number", column, text));
  return value;
}

std::string shown(const Record& record, const std::string& column, const char* form, double scale) {
  const double value = number_in(record, column);
  return std::isnan(value) ? std::string() : fmt::format(fmt::runtime(form), scale * value);
}

std::string text_in(const Record& record, const std::string& column) {
  const auto found = record.find(column);
  return found == record.end() ? std::string() : found->second;
}

std::string csv_line(const std::vector<std::string>& columns, const Record& record) {
  std::string line;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (c > 0) line += ',';
    line += quoted(text_in(record, columns[c]));
  }
  return line + '\n';
}

std::vector<std::string> split_csv(const std::string& line, const std::string& where) {
  std::vector<std::string> values(1);
  bool is_quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (is_quoted && c == '"' && i + 1 < line.size() && line[i + 1] == '"')
      values.back() += line[++i];
    else if (c == '"')
      is_quoted = !is_quoted;
    else if (c == ',' && !is_quoted)
      values.emplace_back();
    else if (c != '\r')
      values.back() += c;
  }
  if (is_quoted) throw InputError(fmt::format("{}: a quote does not close", where));
  return values;
}

Table read_csv(const std::string& path, std::size_t* complete_bytes) {
  const std::string text = read_text(path);
  Table table;
  std::size_t begin = 0, line_number = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', begin)) {
    const std::string where = fmt::format("{}:{}", path, ++line_number);
    const auto values = split_csv(text.substr(begin, end - begin), where);
    begin = end + 1;
    if (line_number == 1) {
      table.columns = values;
      continue;
    }
    if (values.size() != table.columns.size())
      throw InputError(fmt::format("{}: {} values where the head has {}", where, values.size(),
                                   table.columns.size()));
    Record record;
    for (std::size_t c = 0; c < values.size(); ++c) record[table.columns[c]] = values[c];
    table.rows.push_back(std::move(record));
  }
  if (table.columns.empty())
    throw InputError(
        fmt::format("{}: no head line; a result has one, then a row a repetition", path));
  if (complete_bytes != nullptr) *complete_bytes = begin;
  return table;
}

Table without_empty_columns(Table table) {
  const auto is_empty = [&](const std::string& column) {
    return std::ranges::all_of(table.rows,
                               [&](const Record& row) { return text_in(row, column).empty(); });
  };
  if (!table.rows.empty()) std::erase_if(table.columns, is_empty);
  return table;
}

std::string csv_text(const Table& table) {
  std::string text = head_line(table.columns);
  for (const Record& row : table.rows) text += csv_line(table.columns, row);
  return text;
}

void write_csv(const std::string& path, const Table& table) {
  AtomicFile file(path);
  file.write(csv_text(table));
  file.commit();
}

RecordFile::RecordFile(std::string path, std::vector<std::string> columns, bool resume)
    : path_(std::move(path)), columns_(std::move(columns)) {
  if (!resume || ::access(path_.c_str(), F_OK) != 0) return;
  std::size_t keep = 0;
  Table table = read_csv(path_, &keep);
  if (table.columns != columns_)
    throw InputError(
        fmt::format("{}: its columns are not those of this version; run without --resume", path_));
  present_ = std::move(table.rows);
  open();
  if (::ftruncate(descriptor_, off_t(keep)) != 0)
    throw InputError(fmt::format("{}: cannot append: {}", path_, std::strerror(errno)));
}

void RecordFile::open() {
  descriptor_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (descriptor_ < 0)
    throw InputError(fmt::format("{}: cannot append: {}", path_, std::strerror(errno)));
}

void RecordFile::set_aside() {
  if (descriptor_ >= 0) return;
  std::rename(path_.c_str(), (path_ + ".previous").c_str()); // fails if there is no earlier file
}

void RecordFile::start_with(const Record& record) {
  AtomicFile fresh(path_);
  fresh.write(head_line(columns_));
  fresh.write(csv_line(columns_, record));
  set_aside();
  fresh.commit();
  open();
}

RecordFile::~RecordFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void RecordFile::append(const Record& record) {
  if (descriptor_ < 0) return start_with(record);
  const std::string line = csv_line(columns_, record);
  // One write per row: a reader, also after a crash, finds whole rows and at most one torn row.
  if (const int reason = write_all(descriptor_, line); reason != 0)
    throw InputError(
        fmt::format("{}: cannot append: {}; rows before stay", path_, std::strerror(reason)));
  ::fdatasync(descriptor_); // some files cannot be synced; the row is written anyway
}

} // namespace dss
