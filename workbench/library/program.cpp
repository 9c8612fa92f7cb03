#include "library/program.hpp"

#include <algorithm>

#include "etlmon/distance/widen.hpp"
#include "plan/recorder_plan.hpp"

namespace etlc::library {

Program::Program(source::File file, Compiled compiled, const diag::Sink& sink)
    : file_(std::move(file)),
      compiled_(std::move(compiled)),
      tables_(std::make_shared<const execute::Tables>(compiled_.plan)),
      warnings_(diag::render_text(file_, sink)),
      is_used_(model().inputs.size()),
      is_measured_(model().predicates.size()) {
    for (const plan::Monitor& monitor : plan().monitors)
        formulas_.push_back(check::shown(model(), model().monitors[monitor.index].formula));
    for (Index p = 0; p < model().predicates.size(); ++p) {
        names_.push_back(plan::column_name(model(), p));
        texts_.push_back(model().predicates[p].text + model().predicates[p].threshold.text);
    }
    for (const Index input : plan().inputs) is_used_[input] = true;
    for (const Index predicate : plan().predicates) is_measured_[predicate] = true;
}

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
