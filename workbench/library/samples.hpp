// Samples in the memory of the caller, and how the evaluator gets them.
#pragma once

#include <cstdint>

#include "check/model/model.hpp"
#include "execute/inputs.hpp"
#include "library/etlc.h"

namespace etlc::library {

/// Returns the type of an input's elements.
inline std::uint32_t type_of(const check::Input& input) {
    switch (input.type) {
        case check::InputType::boolean: return ETLC_BOOL;
        case check::InputType::f16: return ETLC_F16;
        case check::InputType::i8: return ETLC_I8;
        case check::InputType::scalar:
        case check::InputType::f32: break;
    }
    return ETLC_F32;
}

/// Returns a sample; null where it is missing.
inline const void* at(const etlc_column& column, std::uint64_t step) {
    if (column.data == nullptr || (column.present != nullptr && column.present[step] == 0))
        return nullptr;
    return static_cast<const char*>(column.data) + static_cast<std::int64_t>(step) * column.stride;
}
inline const void* at(const etlc_grid& grid, std::uint64_t steps, std::uint64_t row,
                      std::uint64_t step) {
    if (grid.data == nullptr || (grid.present != nullptr && grid.present[row * steps + step] == 0))
        return nullptr;
    return static_cast<const char*>(grid.data) + static_cast<std::int64_t>(row) * grid.stride +
           static_cast<std::int64_t>(step) * grid.step_stride;
}

/// Converts elements to float32 as the generated class does.
void widen(const check::Input& input, const void* data, float* to);

/// Puts a sample, or that it is missing, where the evaluator reads it.
void take(const check::Input& input, const void* data, execute::Sample& sample);

}  // namespace etlc::library
