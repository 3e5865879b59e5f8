#include "variants/mpi/transports.hpp"
#include "variants/mpi/waiting.hpp"

#include <utility>

namespace dss {
namespace {

/// A message that one persistent request sends or receives many times.
class PersistentMessage {
public:
  PersistentMessage(Way way, HaloLayout layout, int rank, MPI_Comm comm)
      : layout_(std::move(layout)) {
    const int size = count_of(layout_.size);
    is_direct_ = layout_.is_stable && layout_.pieces.size() == 1;
    if (!is_direct_) buffer_.resize(layout_.size);
    std::byte* const memory = is_direct_ ? layout_.pieces.front().at : buffer_.data();
    if (way == Way::out)
      MPI_Send_init(memory, size, MPI_BYTE, rank, 0, comm, &request_);
    else
      MPI_Recv_init(memory, size, MPI_BYTE, rank, 0, comm, &request_);
  }
  PersistentMessage(PersistentMessage&& other) noexcept
      : layout_(std::move(other.layout_)), buffer_(std::move(other.buffer_)),
        is_direct_(other.is_direct_), request_(std::exchange(other.request_, MPI_REQUEST_NULL)) {}
  PersistentMessage& operator=(PersistentMessage&&) = delete;
  ~PersistentMessage() {
    if (request_ != MPI_REQUEST_NULL) MPI_Request_free(&request_);
  }

  void start_sending() {
    if (!is_direct_) gather(layout_, buffer_.data());
    MPI_Start(&request_);
  }
  void start_receiving() { MPI_Start(&request_); }
  void finish() { MPI_Wait(&request_, MPI_STATUS_IGNORE); }
  void finish_receiving() {
    finish();
    if (!is_direct_) scatter(layout_, buffer_.data());
  }
  std::size_t size() const { return layout_.size; }

private:
  HaloLayout layout_;
  std::vector<std::byte> buffer_;
  bool is_direct_ = false;
  MPI_Request request_ = MPI_REQUEST_NULL;
};

class MessageExchange final : public HaloExchange {
public:
  MessageExchange(std::vector<Face> faces, MPI_Comm comm)
      : HaloExchange(std::move(faces)), comm_(comm) {}

  void attach(int copies, const LayoutOf& layout_of) override {
    for (const Face& face : faces_) {
      messages_.emplace_back();
      for (int copy = 0; copy < copies; ++copy) {
        messages_.back().out.emplace_back(Way::out, layout_of(face, Way::out, copy), face.rank,
                                          comm_);
        messages_.back().in.emplace_back(Way::in, layout_of(face, Way::in, copy), face.rank, comm_);
      }
    }
  }

  void send(Side side, int copy) override {
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (faces_[f].side != side) continue;
      messages_[f].in[std::size_t(copy)].start_receiving();
      PersistentMessage& out = messages_[f].out[std::size_t(copy)];
      out.start_sending();
      count(out.size());
    }
  }

  void receive(Side side, int copy) override {
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (faces_[f].side != side) continue;
      FaceMessages& messages = messages_[f];
      const Waiting waiting(faces_[f].rank);
      messages.in[std::size_t(copy)].finish_receiving();
      // Large messages make progress only inside MPI calls. A rank that left with half of its
      // message sent would delay its neighbour by a step.
      messages.out[std::size_t(copy)].finish();
    }
  }

private:
  struct FaceMessages {
    std::vector<PersistentMessage> out, in; ///< of each copy
  };
  MPI_Comm comm_;
  std::vector<FaceMessages> messages_;
};

} // namespace

std::unique_ptr<HaloExchange> make_message_exchange(std::vector<Face> faces, MPI_Comm comm) {
  return std::make_unique<MessageExchange>(std::move(faces), comm);
}

} // namespace dss
