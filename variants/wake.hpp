#pragma once
#include <atomic>

namespace dss {

/// Stores a value and wakes every thread that waits in word.wait().
/// Sequentially consistent, though release says enough of the data: notify_all() of libstdc++ 12 wakes only if it reads a waiter in its table,
/// and x86 may read that before others see a weaker store. A thread that falls asleep in between sleeps for ever (seen once in some 10^5 messages
/// between the members of a hybrid).
template <class T>
void store_and_wake(std::atomic<T>& word, T value) {
  word.store(value, std::memory_order_seq_cst);
  word.notify_all();
}

} // namespace dss
