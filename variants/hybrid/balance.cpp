#include "variants/hybrid/balance.hpp"

#include <algorithm>

namespace dss {

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

std::vector<double> speeds(std::span<const std::size_t> elements, std::span<const double> step_s) {
  std::vector<double> speed;
  for (std::size_t m = 0; m < elements.size(); ++m)
    speed.push_back(double(elements[m]) / step_s[m]);
  return speed;
}

double slowest_step_s(std::span<const std::size_t> elements, std::span<const double> speed) {
  double slowest = 0;
  for (std::size_t m = 0; m < elements.size(); ++m)
    slowest = std::max(slowest, double(elements[m]) / speed[m]);
  return slowest;
}

double Balance::block_s() const { return 40e-3 * double(1 << std::min(moves_, 6)); }

void Balance::add(std::vector<double> step_s) {
  blocks_.push_back(std::move(step_s));
  if (blocks_.size() > blocks_needed) blocks_.pop_front();
}

bool Balance::is_uneven() const {
  const auto slowest = [](const std::vector<double>& block) { // -1: no member is
    const auto [least, most] = std::ranges::minmax_element(block);
    return *least < (1 - tolerated) * *most ? most - block.begin() : std::ptrdiff_t(-1);
  };
  return blocks_.size() == blocks_needed && slowest(blocks_.front()) >= 0 &&
         std::ranges::all_of(blocks_, [&](const auto& block) {
           return slowest(block) == slowest(blocks_.front());
         });
}

std::vector<double> Balance::step_s() const {
  std::vector<double> mean(blocks_.front().size(), 0);
  for (const std::vector<double>& block : blocks_)
    for (std::size_t m = 0; m < mean.size(); ++m) mean[m] += block[m] / double(blocks_.size());
  return mean;
}

void Balance::moved() {
  blocks_.clear();
  ++moves_;
}

bool Balance::pays(double now_s, double gain_s, double steps, double moving_s) {
  return gain_s > worthwhile * now_s && gain_s * steps > moving_s;
}

} // namespace dss
