#pragma once
/// The modelled balance of two executors of unlike speed (variants/balance_model.hpp) as a table: a model with rates as data, nothing
/// is measured (experiments/README.md describes the JSON).
#include "experiments/runner/records.hpp"
#include "experiments/runner/study_reader.hpp"
#include "variants/distribution.hpp"

#include <optional>
#include <string>
#include <vector>

namespace dss {

/// A link between the two, with a name.
struct ModelledLink {
  std::string label;
  Network network;
};

/// Every combination of ratio, plate, link and overlap is a row.
struct BalanceStudy {
  std::string name, title;
  double slow_speed = 0; ///< of the slow one alone, element-steps a second
  std::vector<double> ratios;
  std::vector<int> rows; ///< of plates rows x rows
  std::vector<ModelledLink> links;
};

/// Nothing if the study has no key "balance". @throws InputError: file, JSON pointer, what is wrong
std::optional<BalanceStudy> load_balance(const std::string& study, const std::string& scale);

/// Columns begin with `modelled_`, and every row's status is "modelled".
Table balance_table(const BalanceStudy& study);

/// The table for people.
std::string balance_text(const BalanceStudy& study, const Table& table);

} // namespace dss
