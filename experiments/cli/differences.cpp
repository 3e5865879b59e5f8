#include "experiments/cli/differences.hpp"
#include "experiments/base/records.hpp"
#include "solver/error.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <limits>
#include <optional>

namespace dss {
namespace {

/// Places and times of two files are the same if they differ by less than this part.
constexpr double same = 1e-9;

/// A file of numbers under a line of names, read row by row.
class NumberRows {
public:
  explicit NumberRows(const std::string& path) : path_(path), file_(path) {
    if (!file_) throw InputError(fmt::format("{}: cannot be read", path));
    std::string line;
    std::getline(file_, line);
    columns_ = split_csv(line, fmt::format("{}:1", path));
  }
  const std::string& path() const { return path_; }
  const std::vector<std::string>& columns() const { return columns_; }
  std::optional<std::size_t> find(const std::string& column) const {
    const auto found = std::ranges::find(columns_, column);
    if (found == columns_.end()) return {};
    return std::size_t(found - columns_.begin());
  }
  std::size_t place(const std::string& column) const {
    if (const auto found = find(column)) return *found;
    fail(fmt::format("has no column \"{}\"", column));
  }

  /// False at the end. The values are finite.
  bool next(std::vector<double>& values) {
    if (!std::getline(file_, line_)) return false;
    if (line_.ends_with('\r')) line_.pop_back();
    ++number_;
    values.clear();
    const char *at = line_.data(), *const end = at + line_.size();
    while (values.size() < columns_.size()) {
      double value = 0;
      const auto [stop, error] = std::from_chars(at, end, value);
      if (error != std::errc{} || !std::isfinite(value))
        fail(fmt::format("column \"{}\" has no finite number", columns_[values.size()]));
      values.push_back(value);
      at = stop;
      if (at == end || *at != ',') break;
      ++at;
    }
    if (at != end || values.size() != columns_.size())
      fail(fmt::format("{} values where the head has {}", values.size(), columns_.size()));
    return true;
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", path_, number_, what));
  }

private:
  std::string path_;
  std::ifstream file_;
  std::vector<std::string> columns_;
  std::string line_;
  long number_ = 1;
};

/// A quantity and its columns.
struct Quantity {
  std::string name, unit;
  std::vector<std::string> columns;
};

const std::vector<Quantity> of_states = {{"displacement", "m", {"ux", "uy", "uz"}},
                                         {"rotation", "1", {"qx", "qy", "qz"}},
                                         {"velocity", "m/s", {"vx", "vy", "vz"}},
                                         {"spin", "rad/s", {"wx", "wy", "wz"}},
                                         {"von Mises stress", "Pa", {"stress_vm"}}};
const std::vector<Quantity> of_histories = {
    {"kinetic energy", "J", {"kinetic_energy"}},
    {"energy", "J", {"energy"}},
    {"reaction force", "N", {"reaction_fx", "reaction_fy", "reaction_fz"}},
    {"reaction moment", "N m", {"reaction_mx", "reaction_my", "reaction_mz"}}};
const std::vector<Quantity> of_probes = {
    {"displacement", "m", {"ux", "uy", "uz"}},
    {"velocity", "m/s", {"vx", "vy", "vz"}},
    {"stress", "Pa", {"sxx", "syy", "szz", "syz", "sxz", "sxy"}}};

/// The quantities of a history: those of the body, and those of each probe NAME, "NAME.ux".
std::vector<Quantity> quantities_of_history(const NumberRows& file) {
  std::vector<Quantity> found;
  for (const Quantity& quantity : of_histories)
    if (file.find(quantity.columns.front())) found.push_back(quantity);
  constexpr std::string_view first = ".ux";
  for (const std::string& column : file.columns()) {
    if (!column.ends_with(first)) continue;
    const std::string probe = column.substr(0, column.size() - first.size());
    for (const Quantity& quantity : of_probes) {
      found.push_back({fmt::format("{} at {}", quantity.name, probe), quantity.unit, {}});
      for (const std::string& part : quantity.columns)
        found.back().columns.push_back(fmt::format("{}.{}", probe, part));
    }
  }
  return found;
}

/// Sums up the differences of one quantity, row by row.
class QuantityMeter {
public:
  QuantityMeter(const Quantity& quantity, const NumberRows& a, const NumberRows& b)
      : result_{quantity.name, quantity.unit} {
    for (const std::string& column : quantity.columns)
      of_a_.push_back(a.place(column)), of_b_.push_back(b.place(column));
  }
  /// @param sign_a, sign_b  factors of the values: q and -q are the same rotation
  void add(const std::vector<double>& a, const std::vector<double>& b, double sign_a, double sign_b,
           const std::string& place) {
    double value = 0, difference = 0;
    for (std::size_t part = 0; part < of_a_.size(); ++part) {
      const double first = sign_a * a[of_a_[part]], second = sign_b * b[of_b_[part]];
      value = std::hypot(value, first);
      difference = std::hypot(difference, second - first);
    }
    result_.largest_value = std::max(result_.largest_value, value);
    if (difference >= result_.largest) result_.largest = difference, result_.place = place;
    squares_ += difference * difference;
    ++rows_;
  }
  bool is_rotation() const { return result_.quantity == of_states[1].name; }
  Difference result() const {
    Difference result = result_;
    result.rms = std::sqrt(squares_ / double(rows_));
    return result;
  }

private:
  Difference result_;
  std::vector<std::size_t> of_a_, of_b_;
  double squares_ = 0;
  std::size_t rows_ = 0;
};

std::vector<QuantityMeter> meters_of(const std::vector<Quantity>& quantities, const NumberRows& a,
                                     const NumberRows& b) {
  std::vector<QuantityMeter> meters;
  for (const Quantity& quantity : quantities) meters.emplace_back(quantity, a, b);
  return meters;
}

Differences results_of(std::size_t rows, const std::vector<QuantityMeter>& meters) {
  Differences found{rows, {}};
  for (const QuantityMeter& meter : meters) found.quantities.push_back(meter.result());
  return found;
}

Differences of_two_states(NumberRows& a, NumberRows& b) {
  std::vector<QuantityMeter> meters = meters_of(of_states, a, b);
  const std::size_t qw_a = a.place("qw"), qw_b = b.place("qw"), element = a.place("element");
  std::vector<std::size_t> places_a, places_b; // of what tells that an element is the same
  for (const char* column : {"x", "y", "z"})
    places_a.push_back(a.place(column)), places_b.push_back(b.place(column));
  std::vector<double> of_a, of_b;
  std::size_t rows = 0;
  for (; a.next(of_a); ++rows) {
    if (!b.next(of_b)) b.fail(fmt::format("has {} elements; {} has more", rows, a.path()));
    double size = 0, apart = 0;
    for (std::size_t axis = 0; axis < places_a.size(); ++axis) {
      const double place = of_a[places_a[axis]];
      size = std::max(size, std::abs(place));
      apart = std::max(apart, std::abs(place - of_b[places_b[axis]]));
    }
    if (apart > same * size)
      b.fail(fmt::format("element {:.0f} is at another place than in {}; give two states of one "
                         "body",
                         of_a[element], a.path()));
    const std::string place = fmt::format("element {:.0f}", of_a[element]);
    for (QuantityMeter& meter : meters) {
      const bool turns = meter.is_rotation();
      meter.add(of_a, of_b, turns && of_a[qw_a] < 0 ? -1 : 1, turns && of_b[qw_b] < 0 ? -1 : 1,
                place);
    }
  }
  if (b.next(of_b)) a.fail(fmt::format("has {} elements; {} has more", rows, b.path()));
  if (rows == 0) a.fail("has no elements");
  return results_of(rows, meters);
}

Differences of_two_histories(NumberRows& a, NumberRows& b) {
  std::vector<QuantityMeter> meters = meters_of(quantities_of_history(a), a, b);
  const std::size_t time_a = a.place("t"), time_b = b.place("t");
  std::vector<double> of_a, of_b;
  std::size_t rows = 0;
  bool has_b = b.next(of_b);
  while (has_b && a.next(of_a)) {
    const double time = of_a[time_a], most = same * std::abs(time);
    while (has_b && of_b[time_b] < time - most) has_b = b.next(of_b);
    if (!has_b || of_b[time_b] > time + most) continue;
    for (QuantityMeter& meter : meters)
      meter.add(of_a, of_b, 1, 1, fmt::format("t = {:.6g} s", time));
    ++rows;
  }
  if (rows == 0)
    throw InputError(fmt::format("{} and {} have no time in common; give both the same --every",
                                 a.path(), b.path()));
  return results_of(rows, meters);
}

} // namespace

double Difference::relative() const {
  if (largest == 0) return 0;
  return largest_value > 0 ? largest / largest_value : std::numeric_limits<double>::infinity();
}

Differences differences_of(const std::string& before, const std::string& after) {
  NumberRows a(before), b(after);
  for (const NumberRows* file : {&a, &b})
    if (!file->find("element") && !file->find("kinetic_energy"))
      file->fail("is neither a state (run --state) nor a history (run --history)");
  const bool are_states = a.find("element").has_value();
  if (are_states != b.find("element").has_value())
    throw InputError(fmt::format("{} is a {}, and {} is none; give two of one kind", before,
                                 are_states ? "state" : "history", after));
  return are_states ? of_two_states(a, b) : of_two_histories(a, b);
}

} // namespace dss
