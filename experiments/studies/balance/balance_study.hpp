#pragma once
/// The modelled balance of two executors with different speeds (variants/cost/balance_model.hpp),
/// as a table. Rates are input data; nothing is measured. experiments/README.md describes the JSON.
#include "experiments/base/records.hpp"
#include "experiments/measure/study_file.hpp"
#include "variants/api/distribution.hpp"

#include <optional>
#include <string>
#include <vector>

namespace dss {

/// A named connection between the two executors.
struct ModelledLink {
  std::string label;
  Network network;
};

/// The inputs; every combination of ratio, plate, connection and overlap is a row.
struct BalanceStudy {
  std::string name, title;
  double slow_speed = 0; ///< speed of the slow executor alone [element-steps/s]
  std::vector<double> ratios;
  std::vector<int> rows; ///< plates have rows x rows elements
  std::vector<ModelledLink> links;
};

/// Reads the key "balance". @throws InputError with the file, the JSON pointer and the mistake
BalanceStudy read_balance(const StudyFile& file);

/// The table. Its result columns begin with `modelled_`, and every row has the status "modelled".
Table balance_table(const BalanceStudy& study);

/// The table as text.
std::string balance_text(const BalanceStudy& study, const Table& table);

} // namespace dss
