// SPDX-License-Identifier: MIT
// The kernel once per instruction set. Gives: `baseline`, the version for the target of the build;
// on hosted x86-64 also the versions above it (x86-64-v3: AVX2, FMA and F16C; x86-64-v4: AVX-512),
// among which dispatch.hpp selects. Keeps true: v3 and v4 give the same bits; baseline x86-64,
// which cannot fuse, differs from them within error_bounds.hpp. Freestanding programs, and
// ETLMON_NO_DISPATCH, have only baseline.
#pragma once

#include "etlmon/distance/reach.hpp"
#include "etlmon/distance/storage.hpp"
#include "etlmon/distance/tally.hpp"
#include "etlmon/vectors/pack.hpp"

#if defined(ETLMON_VECTORS)

#if defined(__x86_64__)
// The targets of the functions of a version (ETLMON_TARGET below). They cannot be inlined into
// functions compiled for fewer instructions.
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
#include "etlmon/vectors/vectors.inc"
#include "etlmon/distance/terms.inc"
#include "etlmon/vectors/tiles.inc"
#include "etlmon/vectors/columns.inc"
#include "etlmon/distance/rows.inc"
#include "etlmon/vectors/lanes.inc"
#include "etlmon/distance/run.inc"
#include "etlmon/distance/search.inc"
#include "etlmon/distance/row_values.inc"
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
#include "etlmon/vectors/vectors.inc"
#include "etlmon/distance/terms.inc"
#include "etlmon/vectors/tiles.inc"
#include "etlmon/vectors/columns.inc"
#include "etlmon/distance/rows.inc"
#include "etlmon/vectors/lanes.inc"
#include "etlmon/distance/run.inc"
#include "etlmon/distance/search.inc"
#include "etlmon/distance/row_values.inc"
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

// ---- Every other machine with vectors: those of 16 bytes.
#define ETLMON_TARGET
#define ETLMON_WIDTH 4
#if defined(__aarch64__)
#define ETLMON_TILE_ROWS 4
#else
#define ETLMON_TILE_ROWS 2
#endif
namespace baseline {
// clang-format off
#include "etlmon/vectors/vectors.inc"
#include "etlmon/distance/terms.inc"
#include "etlmon/vectors/tiles.inc"
#include "etlmon/vectors/columns.inc"
#include "etlmon/distance/rows.inc"
#include "etlmon/vectors/lanes.inc"
#include "etlmon/distance/run.inc"
#include "etlmon/distance/search.inc"
#include "etlmon/distance/row_values.inc"
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

#endif
