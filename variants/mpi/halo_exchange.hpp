#pragma once
/// The exchange of halos between ranks: one class for each transport (the strategies are in
/// variants/api/distribution.hpp). This code is also compiled for simulated clusters.
#include "variants/api/distribution.hpp"
#include "variants/api/halo.hpp"

#include <functional>
#include <memory>
#include <mpi.h>
#include <vector>

namespace dss {

/// A face: one neighbour of a part. Rank n computes part n.
struct Face {
  int rank = 0;
  Side side = Side::among;
  std::size_t number = 0; ///< index among the part's neighbours
};
enum class Way { out, in };
std::vector<Face> faces_of(const Part& part);

/// Exchanges the halos of one rank's part with its neighbours. Implementations: transports.hpp.
class HaloExchange : public Halo {
public:
  /// Function that gives the layout of what a face sends or receives in a copy:
  /// Executor::halo_layout, or a stand-in for it.
  using LayoutOf = std::function<HaloLayout(const Face& face, Way way, int copy)>;
  /// Prepares everything that depends on the executor's memory. Collective.
  virtual void attach(int copies, const LayoutOf& layout_of) = 0;
  const Traffic& traffic() const { return traffic_; }
  const std::vector<Face>& faces() const { return faces_; }

protected:
  explicit HaloExchange(std::vector<Face> faces) : faces_(std::move(faces)) {}
  void count(std::size_t bytes) {
    traffic_.messages += 1;
    traffic_.bytes += double(bytes);
  }
  const std::vector<Face> faces_;
  Traffic traffic_;
};

/// Adds up the time of a rank in exchanges, including copies.
class TimedHalo final : public Halo {
public:
  /// @param tell_alone  called with the argument of Halo::work_alone, to tell the other ranks
  TimedHalo(HaloExchange& exchange, std::function<void(bool)> tell_alone);
  void send(Side side, int copy) override;
  void receive(Side side, int copy) override;
  void work_alone(bool is_alone) override { tell_alone_(is_alone); }
  double total_s() const { return total_s_; }

private:
  HaloExchange& exchange_;
  const std::function<void(bool)> tell_alone_;
  /// Sides without neighbours are skipped, since even reading the clock costs time.
  bool has_side_[std::size(all_sides)] = {};
  double total_s_ = 0;
};

} // namespace dss
