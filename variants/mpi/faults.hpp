#pragma once
/// Faults on purpose, for tests of what follows from them: DSSBENCH_FAULT=die:RANK:EXCHANGE,
/// hang:RANK:EXCHANGE or slow:RANK:FACTOR.
#include "variants/api/halo.hpp"

namespace dss {

/// A fault that the environment asks for.
struct Fault {
  enum class Kind { none, die, hang, slow };
  Kind kind = Kind::none;
  double number = 0; ///< number of the exchange, from 1; or the factor
  /// The fault of this rank.
  /// @throws InputError if the environment's text is not a fault
  static Fault of_rank(int rank);
  double slowdown() const { return kind == Kind::slow ? number : 1; }
};

/// Passes all calls on to a halo, and makes this rank fail as asked.
class FaultyHalo final : public Halo {
public:
  FaultyHalo(Halo& halo, const Fault& fault) : halo_(halo), fault_(fault) {}
  void send(Side side, int copy) override;
  void receive(Side side, int copy) override;
  void work_alone(bool is_alone) override { halo_.work_alone(is_alone); }
  /// Call it when computation starts.
  void start();

private:
  Halo& halo_;
  const Fault fault_;
  void compute_slowly() const;
  long exchanges_ = 0;
  double computing_since_s_ = 0; ///< end of the last call, or start() [s]
};

} // namespace dss
