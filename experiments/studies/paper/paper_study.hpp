#pragma once
/// The paper's tables, cell by cell in the paper's order: the published figure, what was measured
/// here, and what was simulated, each in columns of its own. Nothing is measured by this kind; it
/// reads the tables of other studies. README.md describes the JSON.
#include "experiments/base/records.hpp"
#include "experiments/measure/study_file.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace dss {

/// Texts that columns of a table must have; `*` stands for any text. The text "fill" for threads
/// means: as many as fill the cores.
using Where = std::map<std::string, std::string>;

/// One way to run the paper's configuration. Of several cells that fit, the fastest counts.
struct PaperWay {
  std::string name;
  Where measured, simulated; ///< simulated: empty if this way is not simulated
};

/// One figure of the paper's table.
struct PaperCell {
  std::string column;
  double paper = 0;       ///< [s], or a ratio for a speed-up
  bool is_base = false;   ///< the time that speed-ups refer to
  std::string speedup_of; ///< of a speed-up: the column whose time it divides; else empty
  Where where;
};

/// One line of the paper's table.
struct PaperLine {
  std::string name;
  std::vector<PaperCell> cells;
  std::vector<PaperWay> ways;
};

struct PaperStudy {
  std::string name, title, scale, source;
  std::string measured;  ///< name of the table of measured cells
  std::string elsewhere; ///< directory in results/ with the same table of another machine; or empty
  std::string simulated; ///< name of the table of simulated cells; or empty
  std::string figure;    ///< name of a second table with the times alone; or empty
  Where simulated_where;
  double steps = 0; ///< the paper's; times are scaled to them
  std::vector<std::string> bases;
  std::vector<PaperLine> rows;
};

/// Reads the key "paper_table". @throws InputError with the file, the JSON pointer and the mistake
PaperStudy read_paper_study(const StudyFile& file);

/// The tables of other studies that the paper's table is made of.
struct PaperSources {
  Table measured, elsewhere, simulated;
  std::string machine,
      machine_elsewhere; ///< processor and number of cores, or the devices' machine
};

/// The table, in the paper's order. A speed-up has one row for each base.
Table paper_table(const PaperStudy& study, const PaperSources& sources);
/// The times of the table, for the paper's figure.
Table paper_figure(const PaperStudy& study, const Table& table);
/// The table as text.
std::string paper_text(const PaperStudy& study, const Table& table);

} // namespace dss
