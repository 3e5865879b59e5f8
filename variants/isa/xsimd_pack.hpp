#pragma once
/// A pack over a batch of xsimd; the only file that includes xsimd. xsimd 8.1 (Debian 12) has no
/// AVX-512 FMA and no two-source lane shifts: each instruction set adds those as intrinsics.
#include "kernels/simd/inline.hpp"
#include "kernels/simd/lane_mask.hpp"
#include <xsimd/xsimd.hpp>

DSS_INLINE_BEGIN
namespace dss::simd {

/// xsimd's batch with a unary minus that the compiler can fold into a fused multiply-add (xsimd's
/// is 0 - a, an instruction of its own).
/// @tparam Architecture  xsimd's tag of the instruction set
template <class T, class Architecture>
struct XsimdPack {
  using Batch = xsimd::batch<T, Architecture>;
  using Register = typename Batch::register_type;
  Batch batch;
  XsimdPack() = default;
  XsimdPack(T scalar) : batch(scalar) {}
  XsimdPack(Register lanes) : batch(lanes) {}
  XsimdPack(Batch lanes) : batch(lanes) {}
  operator Register() const { return batch; }
  friend XsimdPack operator+(XsimdPack a, XsimdPack b) { return a.batch + b.batch; }
  friend XsimdPack operator-(XsimdPack a, XsimdPack b) { return a.batch - b.batch; }
  friend XsimdPack operator*(XsimdPack a, XsimdPack b) { return a.batch * b.batch; }
  friend XsimdPack operator/(XsimdPack a, XsimdPack b) { return a.batch / b.batch; }
  friend XsimdPack operator-(XsimdPack a) { return Register(-Register(a.batch)); }
};

template <class T, class Architecture>
inline void store(T* p, XsimdPack<T, Architecture> a) {
  a.batch.store_aligned(p);
}

} // namespace dss::simd
DSS_INLINE_END
