#pragma once
#include <atomic>

namespace dss {

/// Stores a value and wakes every thread that waits in word.wait(). The store is sequentially
/// consistent, although release would suffice for the data: notify_all() of libstdc++ 12 wakes only
/// if it reads a waiter in its table, and x86 may do that read before other threads see a weaker
/// store. A thread that falls asleep in between would never wake (README.md).
template <class T>
void store_and_wake(std::atomic<T>& word, T value) {
  word.store(value, std::memory_order_seq_cst);
  word.notify_all();
}

} // namespace dss
