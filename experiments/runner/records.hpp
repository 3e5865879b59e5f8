#pragma once
/// Tidy CSV: tables in memory, records appended as measured, and files read back with what a cut-off left in them.
#include <map>
#include <string>
#include <vector>

namespace dss {

/// A row by column name; a missing column is empty.
using Record = std::map<std::string, std::string>;

/// A table of text: all rows have the columns of the head.
struct Table {
  std::vector<std::string> columns;
  std::vector<Record> rows;
};

/// A number with 17 digits, as every number of a record; an empty text for NaN.
std::string number_text(double value);
/// Number in a column, NaN where it is missing or empty. @throws InputError if there is something else
double number_in(const Record& record, const std::string& column);
/// The same for people, times `scale`, in fmt's form; an empty text for what is missing.
std::string shown(const Record& record, const std::string& column, const char* form, double scale = 1);
/// Text in a column, empty where it is missing.
std::string text_in(const Record& record, const std::string& column);

/// One line of CSV (RFC 4180 quoting, but line breaks in a value become spaces: a line is a record).
std::string csv_line(const std::vector<std::string>& columns, const Record& record);
/// Splits one line of CSV. @throws InputError naming `where` if a quote does not close
std::vector<std::string> split_csv(const std::string& line, const std::string& where);

/// Reads a CSV. A torn last line (no line break at its end) is left out; `complete_bytes`, if given, gets the length
/// without it.
/// @throws InputError if the file cannot be read, has no head, or a row has another number of values than the head
Table read_csv(const std::string& path, std::size_t* complete_bytes = nullptr);

/// Writes a table by temporary and rename. @throws InputError if it cannot be written
void write_csv(const std::string& path, const Table& table);

/// A CSV that grows by one row at a time; each row is on its way to the disk when append() returns.
class RecordFile {
public:
  /// Opens a file. With `resume`, rows present stay (a torn last line is cut off) and are in `present()`; else it starts
  /// anew with the first row, and earlier rows go to PATH.previous.
  /// @throws InputError if it cannot be written, or is resumed with other columns
  RecordFile(std::string path, std::vector<std::string> columns, bool resume);
  RecordFile(const RecordFile&) = delete;
  RecordFile& operator=(const RecordFile&) = delete;
  ~RecordFile();
  /// @throws InputError if the row cannot be written whole
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
