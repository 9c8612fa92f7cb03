// SPDX-License-Identifier: MIT
// The inline namespace of the runtime, named after the compiler and its flags. Takes: the
// compiler's macros. Gives: ETLMON_BUILD, the inline namespace that holds all of the runtime and of
// every generated class: v0_2_0_gcc12_x86v3, v0_2_0_clang14_x86v1_O0. The linker keeps one copy of
// an inline function of a given name. Without this namespace, a unit could run instructions that
// another unit was compiled for, or get results of its -ffast-math. Keeps true: functions of the
// same name are interchangeable, in results and in instructions. docs/runtime.md, "Flags, and who
// shares code", lists flags that define no macro.
#pragma once

#include "etlmon/version.hpp"

#if !(__cplusplus >= 201703L || (defined(_MSVC_LANG) && _MSVC_LANG >= 201703L))
// There is no such file: a missing include is the error after which compilers stop.
#include <etlmon needs C++17: compile with -std=c++17 or later>
#endif

#define ETLMON_JOIN(a, b, c, d, e, f) ETLMON_JOIN_TOKENS(a, b, c, d, e, f)
#define ETLMON_JOIN_TOKENS(a, b, c, d, e, f) a##b##c##d##e##f
#define ETLMON_BUILD_VERSION \
  ETLMON_JOIN(v, ETLMON_VERSION_MAJOR, _, ETLMON_VERSION_MINOR, _, ETLMON_VERSION_PATCH)

#if defined(ETLMON_STANDALONE)
// ---- A short name, for a runtime that is pasted into a header: v0_2_0, or v0_2_0_avx2_fast. Units
// with other vector instructions, or with -ffast-math, get another name.
#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)
#define ETLMON_BUILD_MATH _fast
#else
#define ETLMON_BUILD_MATH
#endif
#if defined(__AVX512F__)
#define ETLMON_BUILD_MACHINE _avx512
#elif defined(__FMA__)
#define ETLMON_BUILD_MACHINE _fma
#elif defined(__AVX2__)
#define ETLMON_BUILD_MACHINE _avx2
#elif defined(__AVX__)
#define ETLMON_BUILD_MACHINE _avx
#else
#define ETLMON_BUILD_MACHINE
#endif
#define ETLMON_BUILD \
  ETLMON_JOIN(ETLMON_BUILD_VERSION, ETLMON_BUILD_MACHINE, ETLMON_BUILD_MATH, , , )

#else
// ETLMON_IS is 1 for a macro that expands to 1, or to version 1.0 of a RISC-V extension, and
// otherwise 0; ETLMON_DIGIT packs four of them into a hex digit.
#define ETLMON_IS(macro) ETLMON_IS_VALUE(macro)
#define ETLMON_IS_VALUE(value) ETLMON_IS_PAIR(ETLMON_IS_##value)
#define ETLMON_IS_1 0, 1
#define ETLMON_IS_1000000 0, 1
#define ETLMON_IS_PAIR(pair) ETLMON_IS_SECOND(pair, 0, 0)
#define ETLMON_IS_SECOND(first, second, ...) second
#define ETLMON_DIGIT(a, b, c, d) \
  ETLMON_DIGIT_OF(ETLMON_IS(a), ETLMON_IS(b), ETLMON_IS(c), ETLMON_IS(d))
#define ETLMON_DIGIT_OF(a, b, c, d) ETLMON_DIGIT_FROM(a, b, c, d)
#define ETLMON_DIGIT_FROM(a, b, c, d) ETLMON_DIGIT_##a##b##c##d
#define ETLMON_DIGIT_0000 0
#define ETLMON_DIGIT_0001 1
#define ETLMON_DIGIT_0010 2
#define ETLMON_DIGIT_0011 3
#define ETLMON_DIGIT_0100 4
#define ETLMON_DIGIT_0101 5
#define ETLMON_DIGIT_0110 6
#define ETLMON_DIGIT_0111 7
#define ETLMON_DIGIT_1000 8
#define ETLMON_DIGIT_1001 9
#define ETLMON_DIGIT_1010 a
#define ETLMON_DIGIT_1011 b
#define ETLMON_DIGIT_1100 c
#define ETLMON_DIGIT_1101 d
#define ETLMON_DIGIT_1110 e
#define ETLMON_DIGIT_1111 f
// ---- Instructions that the unit may use: the name of an x86-64 level, or digits.
#if defined(__x86_64__) || defined(__i386__)
#define ETLMON_BUILD_DIGITS                                                     \
  ETLMON_JOIN(ETLMON_DIGIT(__SSE3__, __SSSE3__, __SSE4_1__, __SSE4_2__),        \
              ETLMON_DIGIT(__POPCNT__, __AVX__, __AVX2__, __FMA__),             \
              ETLMON_DIGIT(__F16C__, __BMI__, __BMI2__, __LZCNT__),             \
              ETLMON_DIGIT(__MOVBE__, __AVX512F__, __AVX512CD__, __AVX512VL__), \
              ETLMON_DIGIT(__AVX512BW__, __AVX512DQ__, __SSE__, __SSE2_MATH__), ETLMON_BUILD_MORE)
#define ETLMON_BUILD_MORE                                                                          \
  ETLMON_JOIN(ETLMON_DIGIT(__AVX512IFMA__, __AVX512VBMI__, __AVX512VBMI2__, __AVX512VNNI__),       \
              ETLMON_DIGIT(__AVX512BITALG__, __AVX512VPOPCNTDQ__, __AVX512FP16__, __AVX512BF16__), \
              ETLMON_DIGIT(__AVX512ER__, __AVX10_1__, __AVX10_2__, __APX_F__),                     \
              ETLMON_DIGIT(__AVXVNNI__, __AVXVNNIINT8__, __AVXVNNIINT16__, __AVXIFMA__),           \
              ETLMON_DIGIT(__GFNI__, __SSE4A__, __FMA4__, __XOP__),                                \
              ETLMON_DIGIT(__TBM__, 0, 0, 0))
#define ETLMON_BUILD_BITS ETLMON_JOIN(0x, ETLMON_BUILD_DIGITS, , , , )
#if ETLMON_BUILD_BITS == 0x00003000000
#define ETLMON_BUILD_MACHINE _x86v1
#elif ETLMON_BUILD_BITS == 0xf8003000000
#define ETLMON_BUILD_MACHINE _x86v2
#elif ETLMON_BUILD_BITS == 0xfff83000000
#define ETLMON_BUILD_MACHINE _x86v3
#elif ETLMON_BUILD_BITS == 0xfffff000000
#define ETLMON_BUILD_MACHINE _x86v4
#else
#define ETLMON_BUILD_MACHINE ETLMON_JOIN(_x86_, ETLMON_BUILD_DIGITS, , , , )
#endif
#elif defined(__aarch64__) || defined(__arm__)
#if defined(__ARM_FP)
#define ETLMON_BUILD_FLOATS __ARM_FP
#else
#define ETLMON_BUILD_FLOATS 0
#endif
#if defined(__ARM_FEATURE_MVE)
#define ETLMON_BUILD_VECTORS __ARM_FEATURE_MVE
#else
#define ETLMON_BUILD_VECTORS ETLMON_DIGIT(__ARM_FEATURE_SVE, __ARM_FEATURE_SVE2, 0, __ARM_NEON)
#endif
#define ETLMON_BUILD_DIGITS                                                                      \
  ETLMON_JOIN(                                                                                   \
      ETLMON_BUILD_VECTORS,                                                                      \
      ETLMON_DIGIT(__ARM_FEATURE_FMA, __ARM_FEATURE_DSP, __ARM_FEATURE_IDIV, __ARM_FEATURE_CLZ), \
      ETLMON_DIGIT(__thumb__, __thumb2__, __ARM_FEATURE_UNALIGNED, __ARM_FP16_FORMAT_IEEE),      \
      ETLMON_DIGIT(__ARM_FEATURE_FP16_SCALAR_ARITHMETIC, __ARM_FEATURE_FP16_VECTOR_ARITHMETIC,   \
                   __ARM_FEATURE_FP16_FML, __ARM_FEATURE_BF16_VECTOR_ARITHMETIC),                \
      ETLMON_DIGIT(__ARM_FEATURE_DOTPROD, __ARM_FEATURE_MATMUL_INT8, __ARM_FEATURE_COMPLEX,      \
                   __ARM_FEATURE_JCVT),                                                          \
      ETLMON_DIGIT(__ARM_FEATURE_ATOMICS, __ARM_FEATURE_QRDMX, __ARM_FEATURE_FRINT,              \
                   __ARM_FEATURE_MOPS))
#define ETLMON_BUILD_MACHINE \
  ETLMON_JOIN(_arm, __ARM_ARCH, _fp, ETLMON_BUILD_FLOATS, _, ETLMON_BUILD_DIGITS)
#elif defined(__riscv)
#if defined(__riscv_flen)
#define ETLMON_BUILD_FLOATS __riscv_flen
#else
#define ETLMON_BUILD_FLOATS 0
#endif
#define ETLMON_BUILD_DIGITS                                                               \
  ETLMON_JOIN(ETLMON_DIGIT(__riscv_mul, __riscv_div, __riscv_atomic, __riscv_compressed), \
              ETLMON_DIGIT(__riscv_fdiv, __riscv_fsqrt, __riscv_vector, __riscv_zba),     \
              ETLMON_DIGIT(__riscv_zbb, __riscv_zbs, __riscv_zbc, __riscv_zicond),        \
              ETLMON_DIGIT(__riscv_zfh, __riscv_zfa, __riscv_zcb, __riscv_zcmp), , )
#define ETLMON_BUILD_MACHINE \
  ETLMON_JOIN(_riscv, __riscv_xlen, _fp, ETLMON_BUILD_FLOATS, _, ETLMON_BUILD_DIGITS)
#else
#define ETLMON_BUILD_MACHINE
#endif

// ---- Compiler and optimisation level.
#if defined(__clang__)
#define ETLMON_BUILD_COMPILER ETLMON_JOIN(_clang, __clang_major__, , , , )
#elif defined(__GNUC__)
#define ETLMON_BUILD_COMPILER ETLMON_JOIN(_gcc, __GNUC__, , , , )
#else
#define ETLMON_BUILD_COMPILER
#endif
#if defined(__OPTIMIZE_SIZE__)
#define ETLMON_BUILD_SPEED _Os
#elif defined(__GNUC__) && !defined(__OPTIMIZE__)
#define ETLMON_BUILD_SPEED _O0
#else
#define ETLMON_BUILD_SPEED
#endif

// ---- Assumptions about floats; versions of the kernels.
#define ETLMON_BUILD_ASSUMED                                                          \
  ETLMON_JOIN(ETLMON_DIGIT(__FAST_MATH__, __FINITE_MATH_ONLY__, __ASSOCIATIVE_MATH__, \
                           __RECIPROCAL_MATH__),                                      \
              ETLMON_DIGIT(__NO_SIGNED_ZEROS__, 0, 0, 0), , , , )
#if ETLMON_JOIN(0x, ETLMON_BUILD_ASSUMED, , , , )
#define ETLMON_BUILD_MATH ETLMON_JOIN(_fast, ETLMON_BUILD_ASSUMED, , , , )
#else
#define ETLMON_BUILD_MATH
#endif
#if defined(ETLMON_PORTABLE)
#define ETLMON_BUILD_KERNELS _portable
#elif defined(ETLMON_NO_DISPATCH) || !__STDC_HOSTED__
#define ETLMON_BUILD_KERNELS _no_dispatch
#else
#define ETLMON_BUILD_KERNELS
#endif

#define ETLMON_BUILD                                                             \
  ETLMON_JOIN(ETLMON_BUILD_VERSION, ETLMON_BUILD_COMPILER, ETLMON_BUILD_MACHINE, \
              ETLMON_BUILD_SPEED, ETLMON_BUILD_MATH, ETLMON_BUILD_KERNELS)
#endif

// ---- Function attributes.
#if defined(__GNUC__)
#define ETLMON_INLINE inline __attribute__((always_inline))
#define ETLMON_COLD __attribute__((noinline, cold))
#else
#define ETLMON_INLINE inline
#define ETLMON_COLD
#endif
// Functions called at every step: inlined where speed counts, shared where size counts.
#if defined(__OPTIMIZE_SIZE__)
#define ETLMON_STEP inline
#else
#define ETLMON_STEP ETLMON_INLINE
#endif
