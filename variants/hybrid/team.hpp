#pragma once
/// A thread for each member of a hybrid, for as long as the members live.
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace dss {

/// The threads of the members.
class Team {
public:
  using Work = std::function<void(std::size_t member)>;
  explicit Team(std::size_t members);
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;
  ~Team();
  std::size_t size() const { return threads_.size(); }
  /// Calls work(member) in each member's thread. Returns when all calls have ended. Work that waits
  /// for other members must not wait for a member that has thrown.
  /// @throws what the first failing member threw
  void run(const Work& work);

private:
  void serve(std::size_t member);

  std::mutex mutex_;
  std::condition_variable begun_, ended_;
  const Work* work_ = nullptr;
  long turn_ = 0;
  std::size_t busy_ = 0;
  bool is_over_ = false;
  std::exception_ptr error_;
  std::vector<std::thread> threads_;
};

} // namespace dss
