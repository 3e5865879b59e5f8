#pragma once
/// tables/chain.csv from the records of the links.
#include "experiments/runner/chain/link_run.hpp"

namespace dss {

/// What a link's records have in common.
std::string chain_cell(std::size_t link, const ChainLink& one);

/// One row a link. A wrong one keeps its time and gets no factor.
Table chain_table(const ChainStudy& study, const std::vector<Record>& records, ChainErrors& errors);

std::string chain_text(const ChainStudy& study, const Table& table);

} // namespace dss
