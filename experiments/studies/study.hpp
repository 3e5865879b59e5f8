#pragma once
/// Interface of a kind of study. A kind is one folder here and one line of registry.cpp.
#include "experiments/base/progress.hpp"
#include "experiments/base/records.hpp"
#include "experiments/measure/study_file.hpp"
#include "experiments/measure/study_paths.hpp"

#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace dss {

/// Where a study runs and how it reports progress.
struct StudyRun {
  std::string directory; ///< directory of raw/, tables/ and oracle/
  StudyPaths paths;      ///< paths of the study's own files
  bool resumes = false;  ///< keep existing records
  long rounds = 0;       ///< stop after so many rounds of repetitions; 0: measure all
  Progress& progress;

  std::function<void(const std::string&)> note() const {
    return [this](const std::string& line) { progress.note(line); };
  }
};

/// A table of a study; `name` is the name of its file.
struct NamedTable {
  std::string name;
  Table table;
};

/// Tables and text of a finished study.
struct StudyResult {
  std::vector<NamedTable> tables; ///< the main table is first; none if rounds are missing for it
  std::string text;               ///< summary for people
  bool is_fine = true;            ///< no check failed
};

/// A result with one table. It is fine if no row has the status "failed".
StudyResult result_of(const std::string& name, Table table, const std::string& text);

/// True if any row of a table has the status "failed".
bool has_failed_rows(const Table& table);

/// A study that was read from a file.
class Study {
public:
  virtual ~Study() = default;
  /// Text of the plan, for --dry-run.
  virtual std::string plan(const StudyPaths& paths) const = 0;
  /// Measures or computes. The caller writes the tables. @throws InputError if nothing can be
  /// recorded
  virtual StudyResult run(const StudyRun& how) = 0;
  /// True if the study itself writes raw/NAME.csv and the circumstances of these records.
  virtual bool keeps_records() const { return false; }
  /// True if the study measures in rounds, and can stop after some of them.
  virtual bool has_rounds() const { return false; }
};

/// A study that makes one table. Its kind gives four functions: `read` (StudyFile -> its own type),
/// `plan_of` (that -> text of the plan), `table_of` (that, or that and StudyRun -> Table),
/// `text_of` (that and the table -> summary).
template <auto read, auto plan_of, auto table_of, auto text_of>
class TableStudy : public Study {
public:
  explicit TableStudy(const StudyFile& file) : study_(read(file)) {}

  std::string plan(const StudyPaths&) const override { return plan_of(study_); }

  StudyResult run(const StudyRun& how) override {
    const Table table = made(how);
    return result_of(study_.name, table, text_of(study_, table));
  }

private:
  using Own = std::invoke_result_t<decltype(read), const StudyFile&>;

  Table made([[maybe_unused]] const StudyRun& how) const {
    if constexpr (std::is_invocable_v<decltype(table_of), const Own&, const StudyRun&>)
      return table_of(study_, how);
    else
      return table_of(study_);
  }

  const Own study_;
};

/// A kind of study: the keys that it reads from a file, and its reader.
struct StudyKind {
  const char* key; ///< a file with this key contains a study of this kind
  std::unique_ptr<Study> (*read)(const StudyFile& file);
  std::vector<std::string> required_keys{}, optional_keys{}; ///< further keys of this kind
};

/// Reader for a `StudyKind`: makes a `Kind` from a file.
template <class Kind>
std::unique_ptr<Study> read_study(const StudyFile& file) {
  return std::make_unique<Kind>(file);
}

} // namespace dss
