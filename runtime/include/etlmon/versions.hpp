// SPDX-License-Identifier: MIT
// The kernel once per instruction set, and which of them runs.
// Gives: `baseline`, the version for the machine that the program is built for; on hosted x86-64
// the versions above it (x86-64-v3: AVX2, FMA and F16C; x86-64-v4: AVX-512), and the pointer
// through which the best one that the CPU has is called (small sets have no third one). Keeps true:
// the pointer is a constant until the first call, and whichever thread sets it writes the same; no
// version runs on a CPU, or under an operating system, that lacks it. v3 and v4 give equal bits;
// baseline x86-64, which cannot fuse, differs from them within error_bounds.hpp. Without dispatch:
// freestanding programs, and ETLMON_NO_DISPATCH.
#pragma once

#include "etlmon/reach.hpp"
#include "etlmon/storage.hpp"
#include "etlmon/tally.hpp"

#if defined(ETLMON_HAS_PACKS) && defined(__x86_64__)
// All that a version's functions are made for (ETLMON_TARGET below): what is compiled for less
// cannot have them inlined.
#if defined(__AVX2__) && defined(__FMA__) && defined(__AVX512F__) && defined(__AVX512VL__) && \
    defined(__AVX512BW__) && defined(__AVX512DQ__)
#define ETLMON_X86_64 4
#elif defined(__AVX2__) && defined(__FMA__) && defined(__F16C__)
#define ETLMON_X86_64 3
#else
#define ETLMON_X86_64 1
#endif
#if ETLMON_X86_64 < 4 && __STDC_HOSTED__ && !defined(ETLMON_NO_DISPATCH)
#define ETLMON_DISPATCH 1
#endif
#endif

namespace etlmon {
inline namespace ETLMON_BUILD {
namespace detail {

#define ETLMON_WIDE ETLMON_TARGET ETLMON_INLINE

// ---- x86-64-v4
#if defined(ETLMON_DISPATCH) || (defined(ETLMON_X86_64) && ETLMON_X86_64 == 4)
#define ETLMON_TARGET __attribute__((target("avx2,fma,avx512f,avx512vl,avx512bw,avx512dq")))
#define ETLMON_WIDTH 16
#define ETLMON_TILE_ROWS 8
#define ETLMON_FUSED 1
namespace x86_64_v4 {
// clang-format off
#include "etlmon/terms.inc"
#include "etlmon/tiles.inc"
#include "etlmon/columns.inc"
#include "etlmon/run.inc"
#include "etlmon/search.inc"
// clang-format on
}  // namespace x86_64_v4
#undef ETLMON_TARGET
#undef ETLMON_WIDTH
#undef ETLMON_TILE_ROWS
#undef ETLMON_FUSED
#endif

// ---- x86-64-v3
#if defined(ETLMON_X86_64) && \
    (ETLMON_X86_64 == 3 || (ETLMON_X86_64 < 3 && defined(ETLMON_DISPATCH)))
#define ETLMON_TARGET __attribute__((target("avx2,fma,f16c")))
#define ETLMON_WIDTH 8
#define ETLMON_TILE_ROWS 4
#define ETLMON_FUSED 1
namespace x86_64_v3 {
// clang-format off
#include "etlmon/terms.inc"
#include "etlmon/tiles.inc"
#include "etlmon/columns.inc"
#include "etlmon/run.inc"
#include "etlmon/search.inc"
// clang-format on
}  // namespace x86_64_v3
#undef ETLMON_TARGET
#undef ETLMON_WIDTH
#undef ETLMON_TILE_ROWS
#undef ETLMON_FUSED
#endif

#if defined(ETLMON_X86_64) && ETLMON_X86_64 == 4
namespace baseline = x86_64_v4;
#elif defined(ETLMON_X86_64) && ETLMON_X86_64 == 3
namespace baseline = x86_64_v3;
#else

// ---- Every other machine: 16-byte vectors where there are some, else scalars.
#define ETLMON_TARGET
#if defined(ETLMON_HAS_PACKS)
#define ETLMON_WIDTH 4
#else
#define ETLMON_WIDTH 1
#endif
#if defined(__aarch64__)
#define ETLMON_TILE_ROWS 4
#else
#define ETLMON_TILE_ROWS 2
#endif
namespace baseline {
// clang-format off
#include "etlmon/terms.inc"
#if defined(ETLMON_HAS_PACKS)
#include "etlmon/tiles.inc"
#include "etlmon/columns.inc"
#endif
#include "etlmon/run.inc"
#include "etlmon/search.inc"
// clang-format on
}  // namespace baseline
#undef ETLMON_TARGET
#undef ETLMON_WIDTH
#undef ETLMON_TILE_ROWS
#endif

#undef ETLMON_WIDE

}  // namespace detail
}  // namespace ETLMON_BUILD
}  // namespace etlmon
