#include "library/interface/call.hpp"

#include <exception>
#include <new>
#include <stdexcept>

#include "data/spill/spill.hpp"

namespace etlc::library {

Message& Message::here() noexcept {
    thread_local Message message;
    return message;
}

void Message::clear() noexcept {
    text_ = "";
    json_ = "{\"diagnostics\": []}\n";
}

void Message::take_diagnostics(std::string text, std::string json) noexcept {
    diagnostics_ = std::move(text);
    if (diagnostics_.ends_with('\n')) diagnostics_.pop_back();
    diagnostics_json_ = std::move(json);
    text_ = diagnostics_.c_str();
    json_ = diagnostics_json_.c_str();
}

void Message::take_warnings(std::string json) noexcept {
    diagnostics_json_ = std::move(json);
    json_ = diagnostics_json_.c_str();
}

etlc_status Message::say_what_failed() noexcept {
    clear();
    try {
        throw;
    } catch (const std::bad_alloc&) {
    } catch (const std::length_error&) {
    } catch (const data::SpillError& error) {
        return say(ETLC_OUT_OF_MEMORY, "{}", error.what());
    } catch (const std::exception& error) {
        return say(ETLC_INTERNAL, "internal error: {}", error.what());
    } catch (...) {
        text_ = "internal error";
        return ETLC_INTERNAL;
    }
    text_ = "there is not enough memory for this";
    return ETLC_OUT_OF_MEMORY;
}

etlc_status check_restarts(const Session& session, std::uint32_t monitor) {
    const std::vector<plan::Monitor>& monitors = session.plan().monitors;
    if (monitor >= monitors.size()) return refuse_index("monitor", monitor, monitors.size());
    if (monitors[monitor].restarts != check::Restarts::never) return ETLC_OK;
    return refuse(ETLC_WRONG_VALUE,
                  "monitor '{}' does not restart: write 'restartable monitor {}' in the spec",
                  monitors[monitor].name, monitors[monitor].name);
}

namespace {

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

/// Checks that the samples of so many strides are in the memory of a process.
etlc_status check_reach(const check::Input& input, std::int64_t stride, std::uint64_t count) {
    constexpr std::int64_t kMost = std::int64_t{1} << 60U;
    std::int64_t reach = 0;
    if (count == 0) return ETLC_OK;
    if (!__builtin_mul_overflow(stride, count - 1, &reach) && reach <= kMost && reach >= -kMost)
        return ETLC_OK;
    return refuse(ETLC_WRONG_VALUE,
                  "input '{}' has {} samples, each {} bytes after the previous one: that is more "
                  "than any memory",
                  input.name, count, stride);
}

etlc_status check_bool(const check::Input& input, const void* data) {
    const std::uint8_t found = *static_cast<const std::uint8_t*>(data);
    if (input.type != check::InputType::boolean || found <= 1) return ETLC_OK;
    return refuse(ETLC_WRONG_VALUE, "input '{}' is the bool {}, expected 0 or 1", input.name,
                  found);
}

}  // namespace

etlc_status check_count(const Session& session, const void* samples, std::size_t count,
                        const char* what) {
    const std::size_t inputs = session.model().inputs.size();
    if (count != inputs)
        return refuse(ETLC_WRONG_NUMBER, "there are {} {}, expected {}: one of each input", count,
                      what, inputs);
    return samples == nullptr && inputs > 0 ? refuse_null(what) : etlc_status{ETLC_OK};
}

etlc_status check_verdicts(const void* verdicts, std::size_t count) {
    if (verdicts == nullptr) return refuse_null("verdicts");
    if (count <= PTRDIFF_MAX / sizeof(etlc_verdict)) return ETLC_OK;
    return refuse(ETLC_WRONG_NUMBER, "there is room for {} verdicts: that is more than any memory",
                  count);
}

etlc_status check_sample(const check::Input& input, const etlc_sample& sample) {
    if (sample.data == nullptr) return ETLC_OK;
    if (const etlc_status failed = check_elements(input, sample.type, sample.count)) return failed;
    if (const etlc_status failed = check_aligned(input, sample.data, 0)) return failed;
    return check_bool(input, sample.data);
}

etlc_status check_grid(const check::Input& input, const etlc_grid& grid, std::uint64_t rows,
                       std::uint64_t steps) {
    if (grid.data == nullptr) return ETLC_OK;
    if (const etlc_status failed = check_elements(input, grid.type, grid.count)) return failed;
    for (const std::int64_t stride : {grid.stride, grid.step_stride})
        if (const etlc_status failed = check_aligned(input, grid.data, stride)) return failed;
    if (const etlc_status failed = check_reach(input, grid.stride, rows)) return failed;
    if (const etlc_status failed = check_reach(input, grid.step_stride, steps)) return failed;
    if (input.type != check::InputType::boolean || steps == 0) return ETLC_OK;
    for (std::uint64_t row = 0; row < rows; ++row)
        for (std::uint64_t step = 0; step < steps; ++step) {
            const void* const flag = at(grid, steps, row, step);
            if (flag == nullptr) continue;
            if (const etlc_status failed = check_bool(input, flag)) return failed;
        }
    return ETLC_OK;
}

}  // namespace etlc::library
