#include "library/samples.hpp"

#include <algorithm>

#include "etlmon/distance/widen.hpp"

namespace etlc::library {

void widen(const check::Input& input, const void* data, float* to) {
    switch (input.type) {
        case check::InputType::boolean:
            *to = *static_cast<const std::uint8_t*>(data) != 0 ? 1.0F : 0.0F;
            return;
        case check::InputType::f16:
            etlmon::widen_f16(static_cast<const std::uint16_t*>(data), to, input.dimension);
            return;
        case check::InputType::i8:
            etlmon::widen_i8(static_cast<const std::int8_t*>(data), input.scale, to,
                             input.dimension);
            return;
        case check::InputType::scalar:
        case check::InputType::f32:
            std::copy_n(static_cast<const float*>(data), input.dimension, to);
            return;
    }
}

void take(const check::Input& input, const void* data, execute::Sample& sample) {
    sample.present = data != nullptr;
    if (!sample.present) return;
    sample.values.resize(input.dimension);
    widen(input, data, sample.values.data());
}

}  // namespace etlc::library
