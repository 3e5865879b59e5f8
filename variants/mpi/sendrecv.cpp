#include "variants/cost/rounds.hpp"
#include "variants/mpi/transports.hpp"
#include "variants/mpi/waiting.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace dss {
namespace {

/// An MPI datatype over the pieces of a layout, relative to the first piece: indexed, or plain
/// bytes if there is one piece.
class PiecesType {
public:
  explicit PiecesType(HaloLayout layout) {
    std::ranges::sort(layout.pieces, {}, &HaloLayout::Piece::offset);
    start_ = layout.pieces.front().at;
    if (layout.pieces.size() == 1) {
      count_ = count_of(layout.size);
      return;
    }
    std::vector<int> lengths;
    std::vector<MPI_Aint> places;
    std::size_t bytes = 0;
    for (const auto& piece : layout.pieces) {
      if (piece.offset != bytes)
        throw std::logic_error("a datatype cannot write a number to two places");
      bytes += piece.count;
      lengths.push_back(count_of(piece.count));
      places.push_back(MPI_Aint(piece.at - start_));
    }
    MPI_Type_create_hindexed(int(lengths.size()), lengths.data(), places.data(), MPI_BYTE, &type_);
    MPI_Type_commit(&type_);
  }
  PiecesType(PiecesType&& other) noexcept
      : start_(other.start_), count_(other.count_), type_(std::exchange(other.type_, MPI_BYTE)) {}
  PiecesType& operator=(PiecesType&&) = delete;
  ~PiecesType() {
    if (type_ != MPI_BYTE) MPI_Type_free(&type_);
  }
  std::byte* start() const { return start_; }
  int count() const { return count_; }
  MPI_Datatype type() const { return type_; }

private:
  std::byte* start_ = nullptr;
  int count_ = 1; ///< number of items of the type
  MPI_Datatype type_ = MPI_BYTE;
};

/// All pairs of neighbouring ranks, ascending. Collective.
std::vector<std::pair<int, int>> edges_of_all(const std::vector<Face>& faces, MPI_Comm comm) {
  const Waiting waiting(Waiting::for_all);
  int rank = 0, ranks = 1, count = 0;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  std::vector<int> upper; // the lower rank of each pair reports it
  for (const Face& face : faces)
    if (face.rank > rank) upper.push_back(face.rank);
  count = int(upper.size());
  std::vector<int> counts(std::size_t(ranks), 0), places(std::size_t(ranks), 0);
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, comm);
  for (std::size_t r = 1; r < counts.size(); ++r) places[r] = places[r - 1] + counts[r - 1];
  std::vector<int> all(std::size_t(places.back() + counts.back()), 0);
  MPI_Allgatherv(upper.data(), count, MPI_INT, all.data(), counts.data(), places.data(), MPI_INT,
                 comm);
  std::vector<std::pair<int, int>> edges;
  for (int r = 0; r < ranks; ++r)
    for (int n = 0; n < counts[std::size_t(r)]; ++n)
      edges.emplace_back(r, all[std::size_t(places[std::size_t(r)] + n)]);
  return edges;
}

class SendrecvExchange final : public HaloExchange {
public:
  SendrecvExchange(std::vector<Face> faces, MPI_Comm comm)
      : HaloExchange(std::move(faces)), comm_(comm) {
    int rank = 0, ranks = 1;
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_size(comm, &ranks);
    const auto edges = edges_of_all(faces_, comm);
    const std::vector<int> rounds = colour_edges(edges, ranks);
    std::vector<std::pair<int, std::size_t>> order; // round and face
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      const std::pair edge{std::min(rank, faces_[f].rank), std::max(rank, faces_[f].rank)};
      const auto found = std::lower_bound(edges.begin(), edges.end(), edge);
      order.emplace_back(rounds[std::size_t(found - edges.begin())], f);
    }
    std::sort(order.begin(), order.end());
    for (const auto& [round, face] : order) order_.push_back(face);
  }

  void attach(int copies, const LayoutOf& layout_of) override {
    for (const Face& face : faces_) {
      types_.emplace_back();
      for (int copy = 0; copy < copies; ++copy) {
        const HaloLayout out = layout_of(face, Way::out, copy);
        types_.back().push_back(
            {PiecesType(out), PiecesType(layout_of(face, Way::in, copy)), out.size});
      }
    }
  }

  void send(Side, int) override {}

  /// Exchanges with all neighbours in the call for the first side: one side after another would
  /// make chains of waiting ranks.
  void receive(Side side, int copy) override {
    if (side != all_sides[0]) return;
    for (const std::size_t f : order_) {
      const Types& types = types_[f][std::size_t(copy)];
      const int rank = faces_[f].rank;
      const Waiting waiting(rank);
      MPI_Sendrecv(types.send.start(), types.send.count(), types.send.type(), rank, 0,
                   types.receive.start(), types.receive.count(), types.receive.type(), rank, 0,
                   comm_, MPI_STATUS_IGNORE);
      count(types.bytes);
    }
  }

private:
  struct Types {
    PiecesType send, receive;
    std::size_t bytes;
  };
  MPI_Comm comm_;
  std::vector<std::size_t> order_;
  std::vector<std::vector<Types>> types_; ///< [face][copy]
};

} // namespace

std::unique_ptr<HaloExchange> make_sendrecv_exchange(std::vector<Face> faces, MPI_Comm comm) {
  return std::make_unique<SendrecvExchange>(std::move(faces), comm);
}

} // namespace dss
