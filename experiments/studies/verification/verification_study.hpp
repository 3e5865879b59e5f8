#pragma once
/// Published problems with published figures. Each is computed on several grids, extrapolated to
/// elements of no size, and compared: how much of the error is the grid's, the model's and the time
/// step's. README.md of this folder describes the JSON.
#include "experiments/base/records.hpp"
#include "experiments/measure/formula.hpp"
#include "experiments/measure/study_file.hpp"

#include <functional>
#include <string>
#include <vector>

namespace dss {

/// A figure of a problem.
struct VerifiedFigure {
  std::string name, unit;
  int mode = 0;         ///< number of a natural frequency [Hz], from 1 on; 0: `column` of a history
  std::string column;   ///< such as "tip.uz"
  std::string minus;    ///< a column that is subtracted from it; empty: none
  bool is_peak = false; ///< the largest absolute value over time instead of the last value
  Formula scale;        ///< the figure is multiplied by it
  double reference = 0; ///< NaN: there is none, and the figure must converge
  double uncertainty = 0; ///< of the reference
  std::string differs;    ///< why it differs from its reference; else empty
};

struct VerificationProblem {
  std::string name, title, source, scene, analysis, model;
  std::vector<Override> set;
  std::string refined;
  std::vector<double>
      values; ///< of the refined parameter: the spacing is proportional to 1 / value
  std::vector<std::string> probes; ///< as --probe
  std::vector<VerifiedFigure> figures;
  double tolerance = 0; ///< relative, of the extrapolated figure
};

struct VerificationStudy {
  std::string name, title, path;
  std::vector<VerificationProblem> problems; ///< with the grids that the scale keeps
};

/// Reads the key "verification". @throws InputError with the file, the JSON pointer and the mistake
VerificationStudy read_verification(const StudyFile& file);

/// Figures of one grid. @throws InputError, UnstableError as the analysis of the scene
struct GridResult {
  std::size_t elements = 0;
  std::vector<double> figures;
};
/// @param steps_factor  times as many steps, each so many times shorter, of a run in time
GridResult solve_grid(const VerificationProblem& problem, double value, long steps_factor = 1);

/// A figure that is extrapolated to elements of no size.
struct Extrapolation {
  double value = 0, uncertainty = 0;
  double order = 0; ///< observed; NaN: the three finest grids show none
};
/// By Richardson's rule, from the three finest grids. An observed order below 1 counts as 1, the
/// least that a lattice has (staircases, clamps at centres): the rule then takes the two finest.
/// Uncertain by the difference to the rule without the finest grid; if there is none, by half of
/// what the rule adds. Without an order: the finest, uncertain by the largest difference of the
/// three finest.
Extrapolation extrapolated(const std::vector<double>& values, const std::vector<double>& figures);

struct VerificationTables {
  Table figures, grids;
};
/// One row a figure, and one row a figure and grid. `status` is "agrees", "converges" (there is no
/// reference), "differs" (as declared) or "failed".
VerificationTables verification_tables(const VerificationStudy& study,
                                       const std::function<void(const std::string&)>& note);
std::string verification_text(const VerificationStudy& study, const Table& figures);

} // namespace dss
