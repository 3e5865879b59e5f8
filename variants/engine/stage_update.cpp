#include "variants/engine/stage_update.hpp"

#include <stdexcept>

namespace dss {

template <class T>
std::vector<StageUpdate<T>> stage_updates(const Method& method, const RowStorage& storage,
                                          int lanes, std::span<const double> dt) {
  static constexpr double whole_step = 1;
  if (method.has_error_stage) dt = {&whole_step, 1};
  std::vector<StageUpdate<T>> updates;
  for (std::size_t s = 0; s < std::size_t(method.stages); ++s) {
    StageUpdate<T> update;
    double first = 0;
    for (std::size_t m = 1; m <= s; ++m) {
      const double alpha = method.alpha[s][m];
      if (alpha == 0) continue;
      update.increments.push_back({int(m) - 1, T(first == 0 ? alpha : alpha / first)});
      if (first == 0) first = alpha;
    }
    update.is_last = int(s) + 1 == method.stages;
    update.action = action_of(method, storage, update.increments.size(), update.is_last);
    // StepMaxima tells whether the result is finite.
    if (method.has_error_stage) update.is_last = false;
    update.low = storage.first_low() * lanes;
    if (storage.is_predicted())
      update.smoothing = T(method.smoothing), update.steps_ahead = T((1 - method.smoothing) / 2);
    const auto beta = [&](double step) {
      return T(step * method.beta[s] / (first == 0 ? 1 : first));
    };
    update.beta = beta(dt.front());
    if (dt.size() > 1) update.betas = Buffer<T>(dt.size());
    for (std::size_t m = 0; m < update.betas.size(); ++m) update.betas.data()[m] = beta(dt[m]);
    if (update.increments.size() > RowTask<T>::most_increments)
      throw std::logic_error("method with more increments than a row task holds");
    updates.push_back(std::move(update));
  }
  return updates;
}

template std::vector<StageUpdate<double>> stage_updates(const Method&, const RowStorage&, int,
                                                        std::span<const double>);
template std::vector<StageUpdate<float>> stage_updates(const Method&, const RowStorage&, int,
                                                       std::span<const double>);

} // namespace dss
