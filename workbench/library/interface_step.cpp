// Steps the monitors of a session.
#include <cmath>
#include <cstring>

#include "etlmon/distance/widen.hpp"
#include "library/call.hpp"

namespace etlc::library {

namespace {

static_assert(sizeof(etlc_verdict) == sizeof(etlmon::Verdict));
static_assert(ETLC_SATISFIED == etlmon::Verdict::kSatisfied &&
              ETLC_VIOLATED == etlmon::Verdict::kViolated &&
              ETLC_DECIDED == etlmon::Verdict::kDecided && ETLC_FINAL == etlmon::Verdict::kFinal);

constexpr const char* kTypes[] = {"ETLC_F32", "ETLC_BOOL", "ETLC_F16", "ETLC_I8"};
constexpr std::uint32_t kBytes[] = {4, 1, 2, 1};

/// Checks the type and number of an input's elements.
etlc_status check_elements(const check::Input& input, std::uint32_t type, std::uint32_t count) {
    if (type != type_of(input))
        return refuse(ETLC_WRONG_TYPE, "input '{}' is given elements of type {}, expected {} ({})",
                      input.name, type, type_of(input), kTypes[type_of(input)]);
    if (count != input.dimension)
        return refuse(ETLC_WRONG_NUMBER, "input '{}' is given {} elements, expected {}", input.name,
                      count, input.dimension);
    return ETLC_OK;
}

etlc_status check_aligned(const check::Input& input, const void* data, std::int64_t stride) {
    const auto place = reinterpret_cast<std::uintptr_t>(data);
    const std::uint32_t bytes = kBytes[type_of(input)];
    if (place % bytes == 0 && stride % static_cast<std::int64_t>(bytes) == 0) return ETLC_OK;
    return refuse(ETLC_WRONG_VALUE,
                  "input '{}' begins at {:#x} with a stride of {} bytes: its elements of {} bytes "
                  "are not aligned",
                  input.name, place, stride, bytes);
}

etlc_status check_bool(const check::Input& input, const void* data) {
    const std::uint8_t found = *static_cast<const std::uint8_t*>(data);
    if (input.type != check::InputType::boolean || found <= 1) return ETLC_OK;
    return refuse(ETLC_WRONG_VALUE, "input '{}' is the bool {}, expected 0 or 1", input.name,
                  found);
}

/// Converts the elements for the evaluator as the generated class does.
void take(const check::Input& input, const void* data, plan::Sample& sample) {
    const std::size_t n = input.dimension;
    sample.present = data != nullptr;
    if (!sample.present) return;
    switch (input.type) {
        case check::InputType::boolean:
            sample.values.assign(1, *static_cast<const std::uint8_t*>(data) != 0 ? 1.0F : 0.0F);
            return;
        case check::InputType::f16:
            sample.values.resize(n);
            etlmon::widen_f16(static_cast<const std::uint16_t*>(data), sample.values.data(),
                              input.dimension);
            return;
        case check::InputType::i8:
            sample.values.resize(n);
            etlmon::widen_i8(static_cast<const std::int8_t*>(data), input.scale,
                             sample.values.data(), input.dimension);
            return;
        case check::InputType::scalar:
        case check::InputType::f32: {
            const auto* const elements = static_cast<const float*>(data);
            sample.values.assign(elements, elements + n);
            return;
        }
    }
}

etlc_status check_room(const Session& session, const void* verdicts, std::size_t count,
                       std::uint64_t steps) {
    const std::size_t monitors = session.plan().monitors.size();
    if (verdicts == nullptr) return refuse_null("verdicts");
    if (count / monitors == steps && count % monitors == 0) return ETLC_OK;
    return refuse(ETLC_WRONG_NUMBER, "there is room for {} verdicts, expected {} x {}", count,
                  steps, monitors);
}

etlc_status check_count(const Session& session, const void* samples, std::size_t count,
                        const char* what) {
    const std::size_t inputs = session.model().inputs.size();
    if (count != inputs)
        return refuse(ETLC_WRONG_NUMBER, "there are {} {}, expected {}: one of each input", count,
                      what, inputs);
    return samples == nullptr && inputs > 0 ? refuse_null(what) : etlc_status{ETLC_OK};
}

etlc_status check_open(const Session& session) {
    if (!session.is_ended()) return ETLC_OK;
    return refuse(ETLC_ENDED,
                  "the episode has ended with etlc_finish(): etlc_reset() begins another one");
}

void give(const std::vector<etlmon::Verdict>& from, etlc_verdict* to) {
    std::memcpy(to, from.data(), from.size() * sizeof *to);
}

etlc_status check_column(const check::Input& input, const etlc_column& column,
                         std::uint64_t steps) {
    if (column.data == nullptr) return ETLC_OK;
    if (const etlc_status failed = check_elements(input, column.type, column.count)) return failed;
    if (const etlc_status failed = check_aligned(input, column.data, column.stride)) return failed;
    if (input.type != check::InputType::boolean) return ETLC_OK;
    const auto* flag = static_cast<const std::uint8_t*>(column.data);
    for (std::uint64_t step = 0; step < steps; ++step, flag += column.stride) {
        if (column.present != nullptr && column.present[step] == 0) continue;
        if (const etlc_status failed = check_bool(input, flag)) return failed;
    }
    return ETLC_OK;
}

/// Returns a sample of a column; null where it is missing.
const void* at(const etlc_column& column, std::uint64_t step) {
    if (column.data == nullptr || (column.present != nullptr && column.present[step] == 0))
        return nullptr;
    return static_cast<const char*>(column.data) + static_cast<std::int64_t>(step) * column.stride;
}

}  // namespace

}  // namespace etlc::library

using namespace etlc;
using namespace etlc::library;

extern "C" {

etlc_status etlc_step(etlc_session session, const etlc_sample* samples, size_t sample_count,
                      etlc_verdict* verdicts, size_t verdict_count) {
    return with_session(session, [&](Session& opened) -> etlc_status {
        if (const etlc_status failed = check_open(opened)) return failed;
        if (const etlc_status failed = check_count(opened, samples, sample_count, "samples"))
            return failed;
        if (const etlc_status failed = check_room(opened, verdicts, verdict_count, 1))
            return failed;
        const std::vector<check::Input>& inputs = opened.model().inputs;
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            if (samples[i].data == nullptr) continue;
            if (const etlc_status failed =
                    check_elements(inputs[i], samples[i].type, samples[i].count))
                return failed;
            if (const etlc_status failed = check_aligned(inputs[i], samples[i].data, 0))
                return failed;
            if (const etlc_status failed = check_bool(inputs[i], samples[i].data)) return failed;
        }
        for (Index i = 0; i < inputs.size(); ++i)
            if (opened.is_used(i)) take(inputs[i], samples[i].data, opened.sample(i));
        give(opened.step(), verdicts);
        return ETLC_OK;
    });
}

etlc_status etlc_run(etlc_session session, const etlc_column* columns, size_t column_count,
                     uint64_t steps, etlc_verdict* verdicts, size_t verdict_count) {
    return with_session(session, [&](Session& opened) -> etlc_status {
        if (const etlc_status failed = check_open(opened)) return failed;
        if (const etlc_status failed = check_count(opened, columns, column_count, "columns"))
            return failed;
        if (const etlc_status failed = check_room(opened, verdicts, verdict_count, steps))
            return failed;
        const std::vector<check::Input>& inputs = opened.model().inputs;
        for (std::size_t i = 0; i < inputs.size(); ++i)
            if (const etlc_status failed = check_column(inputs[i], columns[i], steps))
                return failed;
        for (std::uint64_t step = 0; step < steps; ++step) {
            for (Index i = 0; i < inputs.size(); ++i)
                if (opened.is_used(i)) take(inputs[i], at(columns[i], step), opened.sample(i));
            give(opened.step(), verdicts);
            verdicts += opened.plan().monitors.size();
        }
        return ETLC_OK;
    });
}

etlc_status etlc_finish(etlc_session session, etlc_verdict* verdicts, size_t verdict_count) {
    return with_session(session, [&](Session& opened) -> etlc_status {
        if (const etlc_status failed = check_room(opened, verdicts, verdict_count, 1))
            return failed;
        give(opened.finish(), verdicts);
        return ETLC_OK;
    });
}

etlc_status etlc_reset(etlc_session session) {
    return with_session(session, [](Session& opened) -> etlc_status {
        opened.reset();
        return ETLC_OK;
    });
}

etlc_status etlc_restart(etlc_session session, uint32_t monitor) {
    return with_session(session, [&](Session& opened) -> etlc_status {
        const std::vector<plan::Monitor>& monitors = opened.plan().monitors;
        if (monitor >= monitors.size()) return refuse_index("monitor", monitor, monitors.size());
        if (monitors[monitor].restarts == check::Restarts::never)
            return refuse(ETLC_WRONG_VALUE,
                          "monitor '{}' does not restart: write 'restartable monitor {}' in the "
                          "spec",
                          monitors[monitor].name, monitors[monitor].name);
        opened.restart(monitor);
        return ETLC_OK;
    });
}

etlc_status etlc_observe(etlc_session session, uint32_t predicate, float distance, uint32_t truth) {
    return with_session(session, [&](Session& opened) -> etlc_status {
        const std::vector<check::Predicate>& predicates = opened.model().predicates;
        if (predicate >= predicates.size())
            return refuse_index("predicate", predicate, predicates.size());
        if (!predicates[predicate].threshold.adaptation)
            return refuse(ETLC_WRONG_VALUE, "the threshold of '{}' is not adaptive",
                          opened.predicate_name(predicate));
        if (!std::isfinite(distance))
            return refuse(ETLC_WRONG_VALUE, "distance is {}, expected a finite number", distance);
        if (truth > 1) return refuse(ETLC_WRONG_VALUE, "truth is {}, expected 0 or 1", truth);
        opened.observe(predicate, distance, truth == 1);
        return ETLC_OK;
    });
}

}  // extern "C"
