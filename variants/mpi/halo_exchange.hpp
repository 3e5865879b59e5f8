#pragma once
/// How the halos of parts on ranks are exchanged: one class a transport (variants/distribution.hpp names the
/// strategies). Also compiled for simulated clusters.
#include "variants/distribution.hpp"
#include "variants/halo.hpp"

#include <functional>
#include <memory>
#include <mpi.h>
#include <vector>

namespace dss {

/// One neighbour of a part: rank n computes part n.
struct Face {
  int rank = 0;
  Side side = Side::among;
  std::size_t number = 0; ///< among the part's neighbours
};
enum class Way { out, in };
std::vector<Face> faces_of(const Part& part);

class HaloExchange : public Halo {
public:
  /// Where what a face sends or receives lies in a copy: Executor::halo_layout, or a stand-in for it.
  using LayoutOf = std::function<HaloLayout(const Face& face, Way way, int copy)>;
  /// Makes everything ready that needs to know the memory. Collective.
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

/// Times what an exchange takes of its rank's time, copies included.
class TimedHalo final : public Halo {
public:
  /// @param tell_alone  tells the other ranks what Halo::work_alone says
  TimedHalo(HaloExchange& exchange, std::function<void(bool)> tell_alone);
  void send(Side side, int copy) override;
  void receive(Side side, int copy) override;
  void work_alone(bool is_alone) override { tell_alone_(is_alone); }
  double total_s() const { return total_s_; }

private:
  HaloExchange& exchange_;
  const std::function<void(bool)> tell_alone_;
  bool has_side_[std::size(all_sides)] = {}; ///< sides without neighbours are not worth a look at the clock
  double total_s_ = 0;
};

/// The exchange of a transport between the ranks of `comm`. Collective.
std::unique_ptr<HaloExchange> make_exchange(HaloStrategy::Transport transport, std::vector<Face> faces, MPI_Comm comm);

} // namespace dss
