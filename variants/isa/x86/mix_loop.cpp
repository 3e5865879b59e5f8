#include "variants/isa/machine_code.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace dss {
namespace {

/// True for `count` of the values i = 0 ... total - 1, evenly spread.
bool is_turn(long count, long total, long i) {
  return i * count / total != (i + 1) * count / total;
}

/// Writes the assembly text of a mix.
class MixWriter {
public:
  MixWriter(const InstructionMix& mix, const InstructionSet& isa, bool is_double)
      : isa_(isa), is_double_(is_double), fma_(std::lround(mix.fma)),
        shuffles_(std::lround(mix.shuffles)), sums_(std::lround(mix.sums)),
        products_(std::lround(mix.products)), loads_(std::lround(mix.loads)),
        stores_(std::lround(mix.stores)), arithmetic_(fma_ + shuffles_ + sums_ + products_),
        total_(std::max({arithmetic_, loads_, stores_, 1L})) {}

  std::string text() {
    const int first = first_target(), targets = odd(isa_.registers - first);
    for (int r = 0; r < 3; ++r) add("{} {}, {}", move(), memory("rdi", r), reg(r));
    for (int r = first; r < isa_.registers; ++r) add("{} {}, {}", move(), memory("rdi", 3), reg(r));
    out_ += ".p2align 6\n1:\n";
    for (long i = 0; i < total_; ++i) {
      const std::string target = reg(first + int(i % targets));
      const std::string source = is_turn(loads_, total_, i) ? next_load() : "";
      instruction(i, target, source);
      if (is_turn(stores_, total_, i))
        add("{} {}, {}", move(), reg(first + int((i + 7) % targets)),
            memory("rsi", stored_++ % MixPage::store_lines));
    }
    out_ += "dec %rdx\njnz 1b\n";
    if (!isa_.is_scalar()) out_ += "vzeroupper\n";
    return out_;
  }

private:
  template <class... Words>
  void add(fmt::format_string<Words...> form, Words&&... words) {
    out_ += fmt::format(form, std::forward<Words>(words)...) + '\n';
  }
  std::string reg(int number) const { return fmt::format("%{}{}", isa_.register_name, number); }
  static std::string memory(const char* base, long place) {
    return fmt::format("{}(%{})", place * MixPage::line, base);
  }
  std::string suffix() const {
    return std::string(isa_.is_scalar() ? "s" : "p") + (is_double_ ? "d" : "s");
  }
  std::string move() const { return (isa_.is_scalar() ? "mov" : "vmova") + suffix(); }
  /// An odd number of targets: kinds that alternate then reach every register. A register that is
  /// only multiplied would end in denormals.
  static int odd(int count) { return count % 2 == 0 ? count - 1 : count; }
  int first_target() const { return 4; } // register 3 takes loads whose value is not used
  std::string next_load() {
    return memory("rdi", MixPage::constants + loaded_++ % MixPage::load_lines);
  }

  /// Next kind of instruction: the one furthest behind its share.
  enum Kind { fused, sum, product, lanes_moved, none };
  Kind next_kind(long i) {
    const long counts[] = {fma_, sums_, products_, shuffles_};
    Kind most = none;
    double behind = 0;
    for (int kind = 0; kind < 4; ++kind) {
      const double lag =
          double(counts[kind]) * double(i + 1) / double(total_) - double(made_[kind]);
      if (made_[kind] < counts[kind] && lag > behind) behind = lag, most = Kind(kind);
    }
    if (most != none) ++made_[most];
    return most;
  }
  /// Writes x = 0.98 x + 0.1, x + 0.013 or 0.98 x. A loaded value near 1 may replace an operand. If
  /// the instruction cannot use a load, the load is written separately.
  void instruction(long i, const std::string& x, const std::string& source) {
    const Kind kind = next_kind(i);
    if ((kind == none || kind == lanes_moved) && !source.empty())
      add("{} {}, {}", move(), source, reg(3));
    if (kind == fused)
      add("vfmadd132{} {}, {}, {}", suffix(), source.empty() ? reg(0) : source, reg(1), x);
    else if (kind == lanes_moved)
      add("{} {}, {}", shuffle(), shuffle_operands(x), x);
    else if (kind != none) {
      const char* operation = kind == sum ? "add" : "mul";
      const std::string operand = source.empty() ? reg(kind == sum ? 2 : 0) : source;
      if (isa_.is_scalar())
        add("{}{} {}, {}", operation, suffix(), operand, x);
      else
        add("v{}{} {}, {}, {}", operation, suffix(), operand, x, x);
    }
  }
  std::string shuffle() const {
    if (isa_.is_scalar()) return "shufpd";
    if (isa_.pack_bytes == 64) return is_double_ ? "valignq" : "valignd";
    return is_double_ ? "vpermilpd" : "vpermilps";
  }
  std::string shuffle_operands(const std::string& x) const {
    if (isa_.is_scalar()) return fmt::format("$0, {}", x);
    return isa_.pack_bytes == 64 ? fmt::format("$1, {}, {}", x, x) : fmt::format("$5, {}", x);
  }

  const InstructionSet& isa_;
  const bool is_double_;
  const long fma_, shuffles_, sums_, products_, loads_, stores_, arithmetic_, total_;
  long made_[4] = {}, loaded_ = 0, stored_ = 0;
  std::string out_;
};

} // namespace

std::string mix_loop(const InstructionMix& mix, const InstructionSet& isa, bool is_double) {
  return MixWriter(mix, isa, is_double).text();
}

} // namespace dss
