#include "variants/mpi/faults.hpp"

#include "solver/error.hpp"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <map>
#include <string>
#include <thread>

namespace dss {
namespace {

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

} // namespace

Fault Fault::of_rank(int rank) {
  const char* text = std::getenv("DSSBENCH_FAULT");
  if (text == nullptr) return {};
  static const std::map<std::string, Kind> kinds = {
      {"die", Kind::die}, {"hang", Kind::hang}, {"slow", Kind::slow}};
  char kind[8] = "";
  int faulty = 0;
  double number = 0;
  const bool is_read = std::sscanf(text, "%7[a-z]:%d:%lf", kind, &faulty, &number) == 3;
  if (!is_read || !kinds.contains(kind))
    throw InputError(fmt::format(
        "DSSBENCH_FAULT={}: give die:RANK:EXCHANGE, hang:RANK:EXCHANGE or slow:RANK:FACTOR", text));
  return faulty == rank ? Fault{kinds.at(kind), number} : Fault{};
}

void FaultyHalo::send(Side side, int copy) {
  if (side == all_sides[0]) ++exchanges_;
  if (fault_.kind == Fault::Kind::die && double(exchanges_) >= fault_.number) std::raise(SIGKILL);
  while (fault_.kind == Fault::Kind::hang && double(exchanges_) >= fault_.number)
    std::this_thread::sleep_for(std::chrono::seconds(1));
  compute_slowly();
  halo_.send(side, copy);
  computing_since_s_ = now_s();
}

void FaultyHalo::receive(Side side, int copy) {
  compute_slowly();
  halo_.receive(side, copy);
  computing_since_s_ = now_s();
}

void FaultyHalo::start() { computing_since_s_ = now_s(); }

/// A rank computes between two calls. Prolongs that time by the factor.
void FaultyHalo::compute_slowly() const {
  const double start_s = now_s(), computed_s = start_s - computing_since_s_;
  if (fault_.kind != Fault::Kind::slow) return;
  while (now_s() < start_s + (fault_.number - 1) * computed_s) {
  }
}

} // namespace dss
