/// Adaptive steps of the row executor: tries them stage by stage and accepts them.
#include "variants/engine/row_executor.hpp"
#include "variants/engine/thread_team.hpp"
#include "variants/isa/denormals.hpp"

namespace dss {

template <class T>
StepMaxima RowExecutor<T>::try_step(double dt, std::span<const double> signals) {
  staged_->set_step(dt);
  StepSignals<T> values(signal_count(setup_.problem), setup_.method.stages);
  values.set(signals.data(), setup_.method.stages);
  std::vector<StepMaxima> maxima(std::size_t(staged_->threads()));
  if (is_part()) exchange(&Halo::send, current_copy());
  run_team(staged_->threads(), [&](int thread, auto&& synchronise) {
    const FlushDenormals guard;
    staged_->step(thread, values, true, synchronise);
    maxima[std::size_t(thread)] = staged_->maxima(thread);
  });
  StepMaxima all;
  for (const StepMaxima& one : maxima) all.add(one);
  return all;
}

template <class T>
void RowExecutor<T>::accept_step() {
  run_team(staged_->threads(), [&](int thread, auto&&) { staged_->accept(thread); });
}

#define DSS_INSTANTIATE(T)                                                                         \
  template StepMaxima RowExecutor<T>::try_step(double, std::span<const double>);                   \
  template void RowExecutor<T>::accept_step();
DSS_INSTANTIATE(float)
DSS_INSTANTIATE(double)
#undef DSS_INSTANTIATE

} // namespace dss
