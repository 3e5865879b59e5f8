#include "experiments/measure/ceilings/generated_code.hpp"
#include "solver/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>

namespace dss {
namespace {

// Layout of a memory page in cache lines: constants, then loaded values, then stored values. No
// load has the low address bits of a store: the processor would suspect that the two overlap.
constexpr int line = 64, constants = 4, load_lines = 24, first_store_line = 32, store_lines = 24,
              page = 4096;

/// True for `count` of the values i = 0 ... total - 1, evenly spread.
bool is_turn(long count, long total, long i) {
  return i * count / total != (i + 1) * count / total;
}

/// Writes the assembly text of a mix.
class MixWriter {
public:
  MixWriter(const InstructionMix& mix, const VectorNames& names)
      : names_(names), fma_(std::lround(mix.fma)), shuffles_(std::lround(mix.shuffles)),
        sums_(std::lround(mix.sums)), products_(std::lround(mix.products)),
        loads_(std::lround(mix.loads)), stores_(std::lround(mix.stores)),
        arithmetic_(fma_ + shuffles_ + sums_ + products_),
        total_(std::max({arithmetic_, loads_, stores_, 1L})) {}

  std::string text() {
    const int first = first_target(), targets = odd(names_.registers - first);
    for (int r = 0; r < 3; ++r) add("{} {}, {}", move(), memory("rdi", r), reg(r));
    for (int r = first; r < names_.registers; ++r)
      add("{} {}, {}", move(), memory("rdi", 3), reg(r));
    out_ += ".p2align 6\n1:\n";
    for (long i = 0; i < total_; ++i) {
      const std::string target = reg(first + int(i % targets));
      const std::string source = is_turn(loads_, total_, i) ? next_load() : "";
      instruction(i, target, source);
      if (is_turn(stores_, total_, i))
        add("{} {}, {}", move(), reg(first + int((i + 7) % targets)),
            memory("rsi", stored_++ % store_lines));
    }
    out_ += "dec %rdx\njnz 1b\n";
    if (!names_.is_scalar) out_ += "vzeroupper\n";
    return out_;
  }

private:
  template <class... Words>
  void add(fmt::format_string<Words...> form, Words&&... words) {
    out_ += fmt::format(form, std::forward<Words>(words)...) + '\n';
  }
  std::string reg(int number) const { return fmt::format("%{}{}", names_.reg, number); }
  static std::string memory(const char* base, long place) {
    return fmt::format("{}(%{})", place * line, base);
  }
  std::string move() const { return (names_.is_scalar ? "mov" : "vmova") + names_.suffix; }
  /// An odd number of targets: kinds that alternate then reach every register. A register that is
  /// only multiplied would end in denormals.
  static int odd(int count) { return count % 2 == 0 ? count - 1 : count; }
  int first_target() const { return 4; } // register 3 takes loads whose value is not used
  std::string next_load() { return memory("rdi", constants + loaded_++ % load_lines); }

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
      add("vfmadd132{} {}, {}, {}", names_.suffix, source.empty() ? reg(0) : source, reg(1), x);
    else if (kind == lanes_moved)
      add("{} {}, {}", shuffle(), shuffle_operands(x), x);
    else if (kind != none) {
      const char* operation = kind == sum ? "add" : "mul";
      const std::string operand = source.empty() ? reg(kind == sum ? 2 : 0) : source;
      if (names_.is_scalar)
        add("{}{} {}, {}", operation, names_.suffix, operand, x);
      else
        add("v{}{} {}, {}, {}", operation, names_.suffix, operand, x, x);
    }
  }
  std::string shuffle() const {
    if (names_.is_scalar) return "shufpd";
    if (names_.bytes == 64) return names_.suffix == "pd" ? "valignq" : "valignd";
    return names_.suffix == "pd" ? "vpermilpd" : "vpermilps";
  }
  std::string shuffle_operands(const std::string& x) const {
    if (names_.is_scalar) return fmt::format("$0, {}", x);
    return names_.bytes == 64 ? fmt::format("$1, {}, {}", x, x) : fmt::format("$5, {}", x);
  }

  const VectorNames& names_;
  const long fma_, shuffles_, sums_, products_, loads_, stores_, arithmetic_, total_;
  long made_[4] = {}, loaded_ = 0, stored_ = 0;
  std::string out_;
};

template <class T>
void fill(std::byte* memory) {
  T* numbers = reinterpret_cast<T*>(memory);
  const std::size_t a_line = line / sizeof(T);
  for (std::size_t n = 0; n < page / sizeof(T); ++n) {
    const double starts[] = {0.98, 0.1, 0.013, 0.5};
    const double value = n / a_line < 4 ? starts[n / a_line] : 0.95 + 1e-3 * double(n * 7919 % 101);
    numbers[n] = T(value + 1e-4 * double(n % a_line));
  }
}

} // namespace

VectorNames vector_names(const std::string& isa, const std::string& precision) {
  const bool is_double = precision == "f64";
  if (isa == "avx512") return {"zmm", is_double ? "pd" : "ps", 64, 32, false};
  if (isa == "avx2") return {"ymm", is_double ? "pd" : "ps", 32, 16, false};
  return {"xmm", is_double ? "sd" : "ss", is_double ? 8 : 4, 16, true};
}

GeneratedMix::GeneratedMix(const InstructionMix& mix, const std::string& isa,
                           const std::string& precision)
    : memory_(static_cast<std::byte*>(std::aligned_alloc(page, 2 * page))),
      loop_(MixWriter(mix, vector_names(isa, precision)).text()) {
  for (std::byte* half : {memory_.get(), memory_.get() + page})
    precision == "f64" ? fill<double>(half) : fill<float>(half);
}

void GeneratedMix::run(long passes) const {
  loop_(memory_.get(), memory_.get() + page + first_store_line * line, passes);
}

} // namespace dss
