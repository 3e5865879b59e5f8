#include "experiments/studies/study.hpp"
#include "experiments/studies/paper/paper_study.hpp"
#include "solver/io/atomic_file.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace dss {
namespace {

Table table_if_there(const std::string& path) {
  return std::filesystem::exists(path) ? read_csv(path) : Table{};
}

/// "AMD EPYC, 2 cores", from the circumstances of a study's records.
std::string machine_of(const std::string& context_path) {
  if (!std::filesystem::exists(context_path)) return "";
  const nlohmann::json json = nlohmann::json::parse(read_text(context_path), nullptr, false);
  if (!json.is_object() || !json.contains("context")) return "";
  const nlohmann::json& context = json["context"];
  return fmt::format("{}, {} cores", context.value("cpu_model", "?"),
                     context.value("affinity", nlohmann::json::array()).size());
}

class PaperTables : public Study {
public:
  explicit PaperTables(const StudyFile& file) : study_(read_paper_study(file)) {}

  std::string plan(const StudyPaths&) const override {
    return fmt::format("{}: from the table {}{}\n", study_.name, study_.measured,
                       study_.simulated.empty() ? "" : " and " + study_.simulated);
  }

  StudyResult run(const StudyRun& how) override {
    const StudyPaths measured = study_paths(how.directory, study_.measured);
    if (!std::filesystem::exists(measured.table))
      throw InputError(fmt::format("{}: there is no {}; run `dssbench experiment {}` first",
                                   study_.name, measured.table, study_.measured));
    PaperSources sources{read_csv(measured.table), {}, {}, machine_of(measured.context), ""};
    if (!study_.elsewhere.empty()) {
      const StudyPaths other = study_paths(how.directory + "/" + study_.elsewhere, study_.measured);
      sources.elsewhere = table_if_there(other.table);
      sources.machine_elsewhere = study_.elsewhere + ": " + machine_of(other.context);
    }
    if (!study_.simulated.empty())
      sources.simulated = table_if_there(study_paths(how.directory, study_.simulated).table);
    const Table table = paper_table(study_, sources);
    StudyResult result = result_of(study_.name, table, paper_text(study_, table));
    if (!study_.figure.empty())
      result.tables.push_back({study_.figure, paper_figure(study_, table)});
    return result;
  }

private:
  const PaperStudy study_;
};

} // namespace

extern const StudyKind paper_kind;
const StudyKind paper_kind{"paper_table", read_study<PaperTables>};

} // namespace dss
