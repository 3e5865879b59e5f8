#pragma once
/// Makes tables/chain.csv from the records of the stages.
#include "experiments/studies/chain/stage_run.hpp"

namespace dss {

/// Name of a stage's cell, which its records share.
std::string chain_cell(std::size_t n, const ChainStage& stage);

/// One row for each stage. A wrong stage keeps its time and gets no factor.
Table chain_table(const ChainStudy& study, const std::vector<Record>& records,
                  const ChainErrors& errors);

/// The table as text.
std::string chain_text(const ChainStudy& study, const Table& table);

} // namespace dss
