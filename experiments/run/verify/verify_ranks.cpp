#include "experiments/run/state/state_access.hpp"
#include "experiments/run/verify/verified_methods.hpp"
#include "experiments/run/verify/verify.hpp"
#include "solver/decomposition/decomposition.hpp"
#include "solver/error.hpp"
#include "solver/model/sufficiency/sufficiency.hpp"
#include "solver/numerics/signal_rows.hpp"

#include <fmt/format.h>

namespace dss {

std::vector<VerifyRow> verify_ranks(const Scene& scene, long steps, const Plugin& distributed,
                                    const Plugin& part, int ranks, const std::string& device) {
  const Problem& problem = scene.problem;
  std::vector<VerifyRow> rows;
  for (const Model model : models) {
    if (!why_not(model, problem).empty()) continue;
    for (const Precision precision : precisions)
      for (const Method& method : methods()) {
        // what ranks exchange does not depend on the method's coefficients
        if (!is_brief(method)) continue;
        if (precision != Precision::f64 && (precision == Precision::f32) != (method.name == "rk4"))
          continue;
        const double dt = verified_step(problem, method);
        const auto digest_of = [&](const Plugin& plugin, const Distribution* distribution) {
          const auto executor = plugin.create(
              {problem, method, model, precision, dt, 1, nullptr, distribution, device});
          write_initial_state(*executor, problem);
          executor->advance(steps, signal_rows(problem, method, dt, 0, steps));
          return state_digest(*executor, problem.lattice.element_count, precision);
        };
        const std::uint64_t alone = digest_of(part, nullptr);
        for (const std::string_view decomposition : decomposition_methods())
          for (const HaloStrategy& halo : halo_strategies()) {
            VerifyRow row{
                scene.name,
                std::string(name(model)),
                std::string(name(precision)),
                fmt::format("{}:{}", distributed.name, part.name),
                fmt::format("{} ranks {} {} {}", ranks, decomposition, halo.name, method.name),
                {},
                {},
                VerifyRow::Verdict::passed,
                fmt::format("equal to one process of {}", part.name)};
            const Distribution distribution{ranks, part.name, std::string(decomposition),
                                            std::string(halo.name)};
            try {
              if (const std::string why = why_no_decomposition(decomposition); !why.empty())
                row.verdict = VerifyRow::Verdict::skipped, row.reason = why;
              else if (digest_of(distributed, &distribution) != alone)
                row.verdict = VerifyRow::Verdict::failed,
                row.reason = fmt::format("other bits than one process of {}", part.name);
              // such as more parts than rows; the same on every rank
            } catch (const InputError& error) {
              row.verdict = VerifyRow::Verdict::skipped;
              row.reason = error.what();
            }
            rows.push_back(std::move(row));
            // the other strategies would be skipped too
            if (rows.back().verdict == VerifyRow::Verdict::skipped) break;
          }
      }
  }
  return rows;
}

} // namespace dss
