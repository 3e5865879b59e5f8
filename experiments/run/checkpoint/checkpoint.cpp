#include "experiments/run/checkpoint/checkpoint.hpp"

#include "experiments/base/build_info.hpp"
#include "experiments/run/state/state_access.hpp"
#include "solver/digest.hpp"
#include "solver/error.hpp"
#include "solver/model/file_digest.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace dss {
namespace {

constexpr std::size_t piece = 4096; ///< elements of a block

/// What a fact is called in an error, and the option that sets it.
struct Fact {
  const char *name, *what, *advice;
};
constexpr Fact known_facts[] = {
    {"program", "version of the program", "go on with the program that wrote it"},
    {"members", "number of members (0: a run by itself)",
     "give the --ensemble of the interrupted run"},
    {"problem", "scene", "give the scene and --set of the interrupted run"},
    {"elements", "number of elements", "give the scene and --set of the interrupted run"},
    {"model_asked", "--model", "give that --model"},
    {"model_tolerance", "--model-tolerance",
     "give that --model-tolerance; a watched model (not 0) computes in one process without "
     "--hybrid"},
    {"precision", "--precision", "give that --precision"},
    {"integrator", "--integrator", "give that --integrator"},
    {"rotation", "--rotation", "give that --rotation"},
    {"dt_s", "--dt", "give that --dt"},
    {"rtol", "--rtol", "give that --rtol"},
    {"atol", "--atol", "give that --atol"},
    {"pauses", "pauses of the run",
     "with adaptive steps and watched models, give the --steps, --frames, --output, --history, "
     "--every, --check-state, --check-tail and --no-balance of the interrupted run"},
    {"has_fma", "rounding (fused multiply-add)", "give a --variant that rounds as that run did"},
    {"kept_fields", "numbers an element", "give the --integrator and --precision of that run"},
};

/// Digest of all that a scene says of the problem: its text with overrides, and its voxels and
/// series, which may come from other files.
std::string problem_digest(const RunRequest& request, const RunPlan& plan) {
  nlohmann::json text = read_scene_text(plan.scene.path, request.overrides).root;
  // Names, defaults of a run and what checks need are not part of the problem.
  for (const char* key : {"$schema", "scene", "title", "description", "run", "verify", "tolerance"})
    text.erase(key);
  const Problem& problem = plan.scene.problem;
  return text_digest(text.dump() + file_digest(problem));
}

} // namespace

std::string earlier_checkpoint(const std::string& path) { return path + ".previous"; }

long whole_number(const nlohmann::json& value) {
  constexpr std::uint64_t most = 1'000'000'000'000'000;
  return value.is_number_unsigned() && value.get<std::uint64_t>() <= most ? value.get<long>() : -1;
}

RunIdentity::RunIdentity(const RunRequest& request, const RunPlan& plan, bool is_watched,
                         bool has_fma, int kept_fields, std::span<const long> stops) {
  const ModelChoice& choice = plan.model_choice;
  facts["program"] = build_info().sources.at("core");
  facts["members"] = 0;
  facts["problem"] = problem_digest(request, plan);
  facts["elements"] = plan.scene.problem.lattice.element_count;
  facts["model_asked"] = choice.asked;
  facts["model_tolerance"] = is_watched ? choice.tolerance : 0;
  facts["precision"] = name(plan.precision);
  facts["integrator"] = plan.method->name;
  facts["rotation"] = name(plan.rotation);
  facts["dt_s"] = plan.dt;
  facts["rtol"] = plan.adaptive ? plan.adaptive->rtol : 0;
  facts["atol"] = plan.adaptive ? plan.adaptive->atol : 0;
  // Adaptive steps end at pauses, and a watched model is looked at there. Other runs may be
  // continued beyond their end.
  const bool has_pauses = plan.adaptive || is_watched;
  facts["pauses"] = has_pauses ? text_digest(fmt::format("{}", fmt::join(stops, " "))) : "";
  facts["has_fma"] = has_fma;
  facts["kept_fields"] = kept_fields;
}

CheckpointFile::CheckpointFile(std::string path, const nlohmann::ordered_json& head,
                               Executor& executor, bool is_root)
    : path_(std::move(path)), executor_(executor), is_root_(is_root) {
  try_to([&] { file_.emplace(path_, head); });
}

template <class Act>
void CheckpointFile::try_to(Act&& act) {
  if (!is_root_ || !failure_.empty()) return;
  work_alone(executor_, true);
  try {
    act();
  } catch (const std::exception& error) {
    failure_ = error.what();
  }
  work_alone(executor_, false);
}

void CheckpointFile::write(std::span<const double> numbers) {
  try_to([&] { file_->write(numbers); });
}

std::string CheckpointFile::commit() {
  try_to([&] { file_->commit(earlier_checkpoint(path_)); });
  return failure_;
}

std::string write_checkpoint(const std::string& path, const RunIdentity& identity,
                             const Standing& standing, Executor& executor, std::size_t elements,
                             bool is_root) {
  nlohmann::ordered_json head = identity.facts;
  head["step"] = standing.step;
  head["model"] = name(standing.model);
  head["steps_kept"] = standing.steps_kept.size();
  head["watch_kept"] = standing.watch_kept.size();
  head["history"] = standing.history.columns;
  CheckpointFile file(path, head, executor, is_root);
  for (const auto* list : {&standing.steps_kept, &standing.watch_kept, &standing.history.numbers})
    if (!list->empty()) file.write(*list);
  const std::size_t width = std::size_t(kept_fields(executor));
  std::vector<double> kept(std::min(elements, piece) * width);
  bool is_finite = true;
  for (std::size_t first = 0; first < elements; first += piece) {
    const std::span<double> part(kept.data(), std::min(piece, elements - first) * width);
    save(executor, first, part);
    is_finite &= all_finite(part);
    file.write(part);
  }
  if (!is_finite) return fmt::format("{}: the state is not finite, so it was not saved", path);
  return file.commit();
}

SavedRun::SavedRun(std::string path) : path_(std::move(path)), reader_(path_) {
  const nlohmann::json& head = reader_.head();
  const auto whole = [&](const char* key) {
    return whole_number(head.value(key, nlohmann::json()));
  };
  if (head.value("members", nlohmann::json()) > 0)
    throw InputError(fmt::format("{}: it is of an ensemble; give its --ensemble", path_));
  const auto model = head.find("model");
  standing_.step = whole("step");
  const std::optional<Model> found = model != head.end() && model->is_string()
                                         ? find_model(model->get<std::string>())
                                         : std::nullopt;
  if (standing_.step < 0 || !found || whole("steps_kept") < 0 || whole("watch_kept") < 0)
    throw InputError(fmt::format("{}: its head lacks a key; take an earlier file", path_));
  standing_.model = *found;
  if (whole("steps_kept") > 0) standing_.steps_kept = reader_.next();
  if (whole("watch_kept") > 0) standing_.watch_kept = reader_.next();
  standing_.history.columns = head.value("history", "");
  if (!standing_.history.columns.empty()) standing_.history.numbers = reader_.next();
}

void RunIdentity::require_same(const std::string& path, const nlohmann::json& head) const {
  for (const Fact& fact : known_facts) {
    const nlohmann::json here = facts.at(fact.name),
                         there = head.value(fact.name, nlohmann::json());
    if (here == there) continue;
    // Digests tell nobody anything.
    constexpr std::array<std::string_view, 3> digests = {"program", "problem", "pauses"};
    const bool is_digest = std::ranges::count(digests, fact.name) > 0;
    const std::string values = is_digest || !there.is_primitive()
                                   ? ""
                                   : fmt::format(": {} there, {} here", there.dump(), here.dump());
    throw InputError(fmt::format("{}: the checkpoint is of another run, {} differs{}; {}", path,
                                 fact.what, values, fact.advice));
  }
}

void SavedRun::restore(Executor& executor, std::size_t elements) {
  const std::size_t width = std::size_t(kept_fields(executor));
  for (std::size_t first = 0; first < elements; first += piece) {
    const std::vector<double> kept = reader_.next();
    if (kept.size() != std::min(piece, elements - first) * width)
      throw InputError(
          fmt::format("{}: elements from {} on are missing; take an earlier file", path_, first));
    dss::restore(executor, first, kept);
  }
  reader_.require_end();
}

} // namespace dss
