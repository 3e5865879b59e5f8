#include "experiments/studies/balance/balance_study.hpp"
#include "experiments/base/text_table.hpp"
#include "experiments/measure/study_file.hpp"
#include "variants/cost/balance_model.hpp"

#include <fmt/format.h>

namespace dss {
namespace {

constexpr int rk4_stages = 4, element_bytes = 104; // RK4; 13 numbers in double precision

Record modelled_row(const BalanceStudy& study, double ratio, int rows, const ModelledLink& link,
                    bool is_overlapped) {
  ModelledPlate plate{rows, rk4_stages, ratio * study.slow_speed, study.slow_speed, link.network};
  plate.is_overlapped = is_overlapped;
  plate.element_bytes = element_bytes;
  const ModelledBalance model = modelled_balance(plate);
  return {{"experiment", study.name},
          {"n", fmt::format("{}", rows)},
          {"speed_ratio", number_text(ratio)},
          {"slow_element_steps_per_s", number_text(study.slow_speed)},
          {"fast_element_steps_per_s", number_text(plate.fast_speed)},
          {"link", link.label},
          {"latency_us", number_text(1e6 * link.network.latency_s)},
          {"gb_per_s", number_text(1e-9 / link.network.seconds_a_byte)},
          {"overlapped", is_overlapped ? "yes" : "no"},
          {"modelled_fast_share", number_text(model.fast_share)},
          {"modelled_step_s", number_text(model.step_s)},
          {"modelled_of_sum", number_text(model.of_sum)},
          {"modelled_of_fast", number_text(model.of_fast)},
          {"modelled_joining_pays", model.of_fast > 1 ? "yes" : "no"},
          {"modelled_equal_split_of_fast", number_text(model.equal_split_of_fast)},
          {"status", "modelled"}};
}

} // namespace

BalanceStudy read_balance(const StudyFile& file) {
  ObjectNode(file.scale).finish();
  ObjectNode object(file.part("balance"));
  BalanceStudy balance;
  balance.name = file.name;
  balance.title = file.title;
  balance.slow_speed = object.require("slow_element_steps_per_s").positive();
  balance.ratios = object.require("speed_ratios").positives();
  balance.rows = object.require("n").counts(2);
  for (const Node& item : object.require("links").items(1)) {
    ObjectNode link(item);
    balance.links.push_back({link.require("label").name(),
                             {1e-6 * link.require("latency_us").positive(),
                              1e-9 / link.require("gb_per_s").positive(), 0, 0}});
    link.finish();
  }
  object.finish();
  return balance;
}

Table balance_table(const BalanceStudy& study) {
  Table table{{"experiment", "n", "speed_ratio", "slow_element_steps_per_s",
               "fast_element_steps_per_s", "link", "latency_us", "gb_per_s", "overlapped",
               "modelled_fast_share", "modelled_step_s", "modelled_of_sum", "modelled_of_fast",
               "modelled_joining_pays", "modelled_equal_split_of_fast", "status"},
              {}};
  for (const ModelledLink& link : study.links)
    for (const bool is_overlapped : {false, true})
      for (const int rows : study.rows)
        for (const double ratio : study.ratios)
          table.rows.push_back(modelled_row(study, ratio, rows, link, is_overlapped));
  return table;
}

std::string balance_text(const BalanceStudy& study, const Table& table) {
  std::vector<std::vector<std::string>> rows;
  for (const Record& row : table.rows)
    rows.push_back({text_in(row, "link"), text_in(row, "overlapped"), text_in(row, "n"),
                    shown(row, "speed_ratio", "{:g}"), shown(row, "modelled_fast_share", "{:.3f}"),
                    shown(row, "modelled_of_sum", "{:.3f}"),
                    shown(row, "modelled_of_fast", "{:.3f}"), text_in(row, "modelled_joining_pays"),
                    shown(row, "modelled_equal_split_of_fast", "{:.3f}")});
  return fmt::format(
      "{} ({}): a model, nothing is measured\n{}", study.title, study.name,
      text_table({"link", "overlapped", "n", "fast : slow", "share of the fast", "of the sum",
                  "of the fast alone", "joining pays", "halves, of the fast alone"},
                 rows));
}

} // namespace dss
