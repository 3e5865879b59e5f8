#pragma once
/// How functions of the hot loop are inlined. All of them must be: GCC does so for a flattened row
/// kernel (DSS_FLATTEN), Clang wants it said at each function. Not under sanitizers, where one
/// flattened kernel would compile for minutes.
#ifdef DSS_SANITIZED
#define DSS_FLATTEN
#define DSS_INLINE_BEGIN
#define DSS_INLINE_END
#else
#define DSS_FLATTEN [[gnu::flatten]]
#ifdef __clang__
#define DSS_INLINE_BEGIN                                                                           \
  _Pragma("clang attribute push(__attribute__((always_inline)), apply_to = function)")
#define DSS_INLINE_END _Pragma("clang attribute pop")
#else
#define DSS_INLINE_BEGIN
#define DSS_INLINE_END
#endif
#endif
