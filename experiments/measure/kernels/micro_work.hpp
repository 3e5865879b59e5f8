#pragma once
/// Interface of the work that a microbenchmark times.

namespace dss {

/// A piece of timed work. Each thread and sample makes a new one.
class MicroWork {
public:
  virtual ~MicroWork() = default;
  /// one pass over the working set, or a fixed number of steps or launches
  virtual void pass() = 0;
};

} // namespace dss
