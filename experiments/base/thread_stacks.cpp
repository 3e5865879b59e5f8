#include "experiments/base/thread_stacks.hpp"

#include "solver/error.hpp"

#include <cctype>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <optional>
#include <pthread.h>
#include <string_view>

namespace dss {
namespace {

/// A number and a unit, B, K, M or G; without one, K (OpenMP 5.2, section 21.2.2).
/// @return bytes; nothing for text that libgomp ignores, or that asks for more than a size can hold
std::optional<std::size_t> parse_stack_size(std::string_view text) {
  const auto trim = [&] {
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())) != 0)
      text.remove_prefix(1);
  };
  trim();
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return std::nullopt;
  text.remove_prefix(std::size_t(end - text.data()));
  trim();
  constexpr std::string_view units = "bkmg";
  const char unit =
      text.empty() ? 'k' : char(std::tolower(static_cast<unsigned char>(text.front())));
  const std::size_t power = units.find(unit);
  if (!text.empty()) text.remove_prefix(1);
  trim();
  if (!text.empty() || power == std::string_view::npos || number >> (64 - 10 * power - 1) != 0)
    return std::nullopt;
  return number << (10 * power);
}

/// @return the number of the error, or 0
int try_thread(std::size_t stack) {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  int error = pthread_attr_setstacksize(&attributes, stack);
  pthread_t thread{};
  if (error == 0)
    error = pthread_create(
        &thread, &attributes, [](void*) -> void* { return nullptr; }, nullptr);
  pthread_attr_destroy(&attributes);
  if (error == 0) pthread_join(thread, nullptr);
  return error;
}

} // namespace

void require_thread_stacks() {
  for (const char* name : {"OMP_STACKSIZE", "GOMP_STACKSIZE"}) { // the first that is sound counts
    const char* text = std::getenv(name);
    const std::optional<std::size_t> stack =
        text == nullptr ? std::nullopt : parse_stack_size(text);
    if (!stack) continue;
    // In place of a smaller size, libgomp takes the default.
    if (*stack < std::size_t(PTHREAD_STACK_MIN)) return;
    if (const int error = try_thread(*stack); error != 0)
      throw InputError(fmt::format("{}={}: no thread can have such a stack ({}); unset it, or give "
                                   "4M",
                                   name, text, std::strerror(error)));
    return;
  }
}

} // namespace dss
