#include "experiments/base/parallel.hpp"

#include <omp.h>

namespace dss {

void for_each_on_team(int threads, std::size_t count,
                      const std::function<void(std::size_t, std::size_t)>& work) {
  Turns turns(count, work);
  if (threads == 1) {
    turns.take(0); // a region of one thread would make the regions inside it nested
  } else {
#pragma omp parallel num_threads(threads)
    turns.take(std::size_t(omp_get_thread_num()));
  }
  turns.rethrow();
}

} // namespace dss
