#include "library/interface/call.hpp"

#include <exception>
#include <new>
#include <stdexcept>

#include "data/spill/spill.hpp"

namespace etlc::library {

namespace {

constexpr const char* kNoDiagnostics = "{\"diagnostics\": []}\n";

}  // namespace

Message& Message::here() noexcept {
    thread_local Message message;
    return message;
}

void Message::clear() noexcept {
    text_ = "";
    json_ = kNoDiagnostics;
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
        text_ = "there is not enough memory for this";
        return ETLC_OUT_OF_MEMORY;
    } catch (const std::length_error&) {
        text_ = "there is not enough memory for this";
        return ETLC_OUT_OF_MEMORY;
    } catch (const data::SpillError& error) {
        try {
            return say(ETLC_OUT_OF_MEMORY, "{}", error.what());
        } catch (...) {
            text_ = "there is not enough memory for this";
            return ETLC_OUT_OF_MEMORY;
        }
    } catch (const std::exception& error) {
        try {
            return say(ETLC_INTERNAL, "internal error: {}", error.what());
        } catch (...) {
            text_ = "internal error";
        }
    } catch (...) {
        text_ = "internal error";
    }
    return ETLC_INTERNAL;
}

etlc_status check_restarts(const Session& session, std::uint32_t monitor) {
    const std::vector<plan::Monitor>& monitors = session.plan().monitors;
    if (monitor >= monitors.size()) return refuse_index("monitor", monitor, monitors.size());
    if (monitors[monitor].restarts != check::Restarts::never) return ETLC_OK;
    return refuse(ETLC_WRONG_VALUE,
                  "monitor '{}' does not restart: write 'restartable monitor {}' in the spec",
                  monitors[monitor].name, monitors[monitor].name);
}

}  // namespace etlc::library
