// SPDX-License-Identifier: MIT
// The size of a class with one pointer. Takes: the bytes of its other members, which are 32-bit
// words. Gives: sizeof the class, for any pointer size.
#pragma once

#include <stddef.h>

#include "etlmon/build.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

constexpr size_t with_pointer(size_t bytes) noexcept {
  return (bytes + 2 * sizeof(void*) - 1) / sizeof(void*) * sizeof(void*);
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
