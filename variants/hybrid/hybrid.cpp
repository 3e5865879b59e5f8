#include "variants/hybrid/hybrid.hpp"

#include "variants/hybrid/choice.hpp"

namespace dss {
namespace {

/// Passes every call on to the choice: a single executor of the whole scene, or several members.
class HybridExecutor final : public Executor, public HybridMembers {
public:
  explicit HybridExecutor(Choice choice) : choice_(std::move(choice)), chosen_(*choice_.executor) {}
  void write(std::size_t first, std::span<const double> fields) override {
    chosen_.write(first, fields);
  }
  void read(std::size_t first, std::span<double> fields) override { chosen_.read(first, fields); }
  void derivative(std::span<const double> signals, std::span<double> rates) override {
    chosen_.derivative(signals, rates);
  }
  Outcome advance(long steps, std::span<const double> signals) override {
    return chosen_.advance(steps, signals);
  }
  std::string schedule() const override { return chosen_.schedule(); }
  int workers() const override { return chosen_.workers(); }
  std::size_t bytes() const override { return chosen_.bytes(); }

  StepTrials* step_trials() override { return chosen_.step_trials(); }
  StateTransfer* state_transfer() override { return chosen_.state_transfer(); }
  DeviceWork* device_work() override { return chosen_.device_work(); }
  HybridMembers* hybrid_members() override { return this; }
  HybridInfo hybrid_info() const override {
    HybridInfo info = dss::hybrid_info(chosen_);
    if (info.members.empty())
      info.members = {{name(choice_.participants.front().member), choice_.speed, 1,
                       choice_.speed > 0 ? choice_.elements / choice_.speed : 0}};
    info.reason = choice_.reason;
    return info;
  }

private:
  const Choice choice_;
  Executor& chosen_;
};

} // namespace

std::unique_ptr<Executor> create_hybrid(const Setup& setup) {
  Choice choice = choose(setup);
  choice.elements = double(setup.problem.lattice.element_count);
  if (choice.executor == nullptr) choice.executor = make_executor(setup, choice.participants);
  return std::make_unique<HybridExecutor>(std::move(choice));
}

} // namespace dss
