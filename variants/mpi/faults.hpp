#pragma once
/// Faults on purpose, so that what follows from them can be tested: DSSBENCH_FAULT=die:RANK:EXCHANGE, hang:RANK:EXCHANGE or
/// slow:RANK:FACTOR.
#include "variants/halo.hpp"

namespace dss {

struct Fault {
  enum class Kind { none, die, hang, slow };
  Kind kind = Kind::none;
  double number = 0; ///< of the exchange, from 1; or factor
  /// The one asked for on this rank. @throws InputError for one that is none of these
  static Fault of_rank(int rank);
  double slowdown() const { return kind == Kind::slow ? number : 1; }
};

/// A halo whose rank meets a fault.
class FaultyHalo final : public Halo {
public:
  FaultyHalo(Halo& halo, const Fault& fault) : halo_(halo), fault_(fault) {}
  void send(Side side, int copy) override;
  void receive(Side side, int copy) override;
  void work_alone(bool is_alone) override { halo_.work_alone(is_alone); }
  /// Computation starts now.
  void start();

private:
  Halo& halo_;
  const Fault fault_;
  void compute_slowly() const;
  long exchanges_ = 0;
  double computing_since_s_ = 0; ///< end of the last call, or start()
};

} // namespace dss
