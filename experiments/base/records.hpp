#pragma once
/// CSV files: tables in memory, rows appended one by one, and files read back even if a crash cut
/// the last row.
#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace dss {

/// A row, by column name; a missing column counts as empty.
using Record = std::map<std::string, std::string>;

/// A table of texts: all rows have the columns of the head.
struct Table {
  std::vector<std::string> columns;
  std::vector<Record> rows;

  bool has_column(const std::string& name) const {
    return std::find(columns.begin(), columns.end(), name) != columns.end();
  }
};

/// The shortest text that reads back as the same number; empty for NaN.
std::string number_text(double value);
/// Number in a column; NaN if the column is missing or empty. @throws InputError for other text
double number_in(const Record& record, const std::string& column);
/// A number for people, times `scale`, in fmt's format `form`; empty if it is missing.
std::string shown(const Record& record, const std::string& column, const char* form,
                  double scale = 1);
/// Text in a column; empty if it is missing.
std::string text_in(const Record& record, const std::string& column);

/// One line of CSV, quoted as in RFC 4180. Line breaks in a value become spaces, so that each
/// record is one line.
std::string csv_line(const std::vector<std::string>& columns, const Record& record);
/// Splits one line of CSV. @throws InputError with `where` if a quote does not close
std::vector<std::string> split_csv(const std::string& line, const std::string& where);

/// Reads a CSV file. A torn last line (without a line break) is ignored.
/// @param complete_bytes  if given, receives the length of the file without the torn line
/// @throws InputError if the file cannot be read, has no head, or has a row of another length than
/// the head
Table read_csv(const std::string& path, std::size_t* complete_bytes = nullptr);

/// The table without columns that are empty in every row.
Table without_empty_columns(Table table);

/// A table as CSV, with its head.
std::string csv_text(const Table& table);
/// Writes a table to a temporary file and renames it. @throws InputError if it cannot be written
void write_csv(const std::string& path, const Table& table);

/// A CSV file that grows row by row. When append() returns, the row is written and synced.
class RecordFile {
public:
  /// Opens a file. With `resume`, existing rows stay and are in `present()`; a torn last row is cut
  /// off. Otherwise the first row starts a new file, and the earlier file becomes PATH.previous.
  /// @throws InputError if it cannot be written, or is resumed with other columns
  RecordFile(std::string path, std::vector<std::string> columns, bool resume);
  RecordFile(const RecordFile&) = delete;
  RecordFile& operator=(const RecordFile&) = delete;
  ~RecordFile();
  /// Before the first row: the earlier file becomes PATH.previous at once. So its records never
  /// stand beside what describes the new ones.
  void set_aside();
  /// @throws InputError if the row cannot be written completely
  void append(const Record& record);
  const std::vector<Record>& present() const { return present_; }

private:
  void start_with(const Record& record);
  void open();

  std::string path_;
  std::vector<std::string> columns_;
  std::vector<Record> present_;
  int descriptor_ = -1;
};

} // namespace dss
