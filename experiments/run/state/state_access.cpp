#include "experiments/run/state/state_access.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace dss {
namespace {

constexpr std::size_t piece_elements = 4096;
constexpr double negligible = 1e-3;

struct Group {
  int first, end;
};
constexpr Group groups[4] = {{ux, vx}, {qs, wx}, {vx, qs}, {wx, field_count}}; // u, q, v, w

double largest_difference(std::span<const double> a, std::span<const double> b,
                          const Group& group) {
  double most = 0;
  for (std::size_t element = 0; element < a.size(); element += field_count)
    for (int field = group.first; field < group.end; ++field) {
      const double difference =
          std::abs(a[element + std::size_t(field)] - b[element + std::size_t(field)]);
      if (!std::isfinite(difference)) return std::numeric_limits<double>::infinity();
      most = std::max(most, difference);
    }
  return most;
}

} // namespace

void write_initial_state(Executor& executor, const Problem& problem) {
  std::vector<double> fields;
  for (std::size_t first = 0; first < problem.lattice.element_count; first += piece_elements) {
    const std::size_t count = std::min(piece_elements, problem.lattice.element_count - first);
    fields.assign(count * field_count, std::numeric_limits<double>::quiet_NaN());
    initial_state(problem, first, count, fields.data());
    executor.write(first, fields);
  }
}

void for_each_piece(Executor& executor, std::size_t element_count,
                    const std::function<void(std::size_t, std::span<const double>)>& visit) {
  std::vector<double> fields;
  for (std::size_t first = 0; first < element_count; first += piece_elements) {
    const std::size_t count = std::min(piece_elements, element_count - first);
    // makes numbers that are not read visible
    fields.assign(count * field_count, std::numeric_limits<double>::quiet_NaN());
    executor.read(first, fields);
    visit(first, fields);
  }
}

std::vector<double> whole_state(Executor& executor, std::size_t element_count) {
  std::vector<double> state(element_count * field_count, std::numeric_limits<double>::quiet_NaN());
  executor.read(0, state);
  return state;
}

bool all_finite(std::span<const double> numbers) {
  return std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); });
}

std::optional<std::size_t> first_not_finite(std::span<const double> state) {
  const auto bad =
      std::ranges::find_if_not(state, [](double field) { return std::isfinite(field); });
  if (bad == state.end()) return std::nullopt;
  return std::size_t(bad - state.begin()) / field_count;
}

std::optional<std::size_t> first_not_finite(Executor& executor, std::size_t element_count) {
  std::optional<std::size_t> found;
  for_each_piece(executor, element_count, [&](std::size_t first, std::span<const double> fields) {
    if (const auto bad = found ? std::nullopt : first_not_finite(fields)) found = first + *bad;
  });
  return found;
}

double max_displacement(std::span<const double> state) {
  double most = 0;
  for (std::size_t element = 0; element < state.size(); element += field_count)
    most =
        std::max(most, std::hypot(state[element + ux], state[element + uy], state[element + uz]));
  return most;
}

double max_displacement(Executor& executor, std::size_t element_count) {
  double most = 0;
  for_each_piece(executor, element_count, [&](std::size_t, std::span<const double> fields) {
    most = std::max(most, max_displacement(fields));
  });
  return most;
}

void StateDigest::add(std::span<const double> fields) {
  for (const double field : fields) {
    const std::uint64_t word = common_bits(field, precision_);
    // FNV-1a spreads bits only upwards. The rotation moves the high bits of a double down first.
    hash_ = (hash_ ^ std::rotl(word, 32)) * 0x100000001b3u;
    hash_ ^= hash_ >> 29;
  }
}

std::uint64_t state_digest(Executor& executor, std::size_t element_count, Precision precision) {
  StateDigest digest(precision);
  for_each_piece(executor, element_count,
                 [&](std::size_t, std::span<const double> fields) { digest.add(fields); });
  return digest.value();
}

KindValues largest_of_kinds(std::span<const double> state) {
  KindValues most{};
  // One pass, because a state may be larger than the cache.
  for (std::size_t element = 0; element < state.size(); element += field_count)
    for (std::size_t kind = 0; kind < most.size(); ++kind)
      for (int field = groups[kind].first; field < groups[kind].end; ++field)
        most[kind] = std::max(most[kind], std::abs(state[element + std::size_t(field)]));
  return most;
}

KindValues largest_differences(std::span<const double> expected, std::span<const double> actual) {
  KindValues most{};
  for (std::size_t kind = 0; kind < most.size(); ++kind)
    most[kind] = largest_difference(expected, actual, groups[kind]);
  return most;
}

KindValues error_scales(const Problem& problem, const KindValues& largest_expected) {
  const double edge = shortest_edge(problem);
  const auto [u, q, v, w] = largest_expected;
  return {std::max(u, negligible * q * edge), std::max(q, negligible * u / edge),
          std::max(v, negligible * w * edge), std::max(w, negligible * v / edge)};
}

double state_error(const Problem& problem, std::span<const double> expected,
                   std::span<const double> actual) {
  const KindValues scales = error_scales(problem, largest_of_kinds(expected)),
                   differences = largest_differences(expected, actual);
  double error = 0;
  for (std::size_t kind = 0; kind < scales.size(); ++kind)
    error = std::max(error, relative(differences[kind], scales[kind]));
  return error;
}

double displacement_difference(const std::vector<double>& state,
                               const std::vector<double>& reference) {
  if (state.size() != reference.size() || state.empty())
    return std::numeric_limits<double>::quiet_NaN();
  double most = 0, largest = 0;
  for (std::size_t n = 0; n < state.size(); ++n) {
    if (int(n % field_count) > uz) continue;
    const double difference = std::abs(state[n] - reference[n]);
    if (std::isnan(difference)) return difference;
    most = std::max(most, difference);
    largest = std::max(largest, std::abs(reference[n]));
  }
  return largest > 0 ? most / largest : most;
}

} // namespace dss
