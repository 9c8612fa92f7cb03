// Opens and closes sessions, and returns messages.
#include <cstddef>
#include <cstring>
#include <string>
#include <vector>

#include "compile.hpp"
#include "diag/diag.hpp"
#include "library/interface/call.hpp"
#include "library/settings.hpp"
#include "library/version.hpp"
#include "recordings/open.hpp"

namespace etlc::library {

namespace {

/// The options of a compilation.
struct Wish {
    check::Options check = {.open_trace = recordings::open_trace};
    CompileOptions plan;
};

std::string text_of(const char* words) {
    return words == nullptr ? "" : words;
}

etlc_status take_settings(const etlc_options& options, Wish& wish) {
    if (options.setting_count > 0 && options.settings == nullptr)
        return refuse_null("options.settings");
    constexpr std::size_t kMostSettings = 10'000;
    if (options.setting_count > kMostSettings)
        return refuse(ETLC_WRONG_NUMBER, "options.setting_count is {}, expected at most {}",
                      options.setting_count, kMostSettings);
    std::vector<std::string> words;
    for (std::size_t i = 0; i < options.setting_count; ++i) {
        if (options.settings[i] == nullptr) return refuse_null("an element of options.settings");
        words.emplace_back(options.settings[i]);
    }
    std::string why;
    auto settings = parse_settings(words, "options.settings", why);
    if (!settings) return refuse(ETLC_WRONG_VALUE, "{}", why);
    wish.check.settings = std::move(*settings);
    return ETLC_OK;
}

etlc_status take_recorder(const etlc_options& options, Wish& wish) {
    if (options.recorder == nullptr) return ETLC_OK;
    std::string why;
    wish.plan.recorder = parse_recorder(options.recorder, why);
    return wish.plan.recorder ? etlc_status{ETLC_OK}
                              : refuse(ETLC_WRONG_VALUE, "options.recorder: {}", why);
}

etlc_status take_choices(const etlc_options& options, Wish& wish) {
    const auto beyond = [](const char* what, std::uint32_t found, std::uint32_t most) {
        return refuse(ETLC_WRONG_VALUE, "options.{} is {}, expected a number from 0 to {}", what,
                      found, most);
    };
    if (options.values > ETLC_BOOLEAN) return beyond("values", options.values, ETLC_BOOLEAN);
    if (options.targets_as > ETLC_AS_I8)
        return beyond("targets_as", options.targets_as, ETLC_AS_I8);
    if (options.lets > 1) return beyond("lets", options.lets, 1);
    if (options.reserved != 0) return beyond("reserved", options.reserved, 0);
    if (options.values == ETLC_BOOLEAN) wish.plan.values = check::Values::boolean;
    constexpr plan::Storage kStorages[] = {plan::Storage::f32, plan::Storage::f16,
                                           plan::Storage::i8};
    wish.plan.targets_as = kStorages[options.targets_as];
    wish.check.lets = options.lets == 1;
    plan::Limits& limits = wish.plan.limits;
    if (options.max_state != 0) limits.state_bytes = options.max_state;
    if (options.max_code != 0) limits.code_bytes = options.max_code;
    if (options.max_work != 0) limits.operations = options.max_work;
    // The size of the observations in bytes must not overflow.
    constexpr std::uint64_t kLongestHistory = std::uint64_t{1} << 40U;
    if (options.history > kLongestHistory)
        return refuse(ETLC_WRONG_VALUE, "options.history is {}, expected at most {} steps",
                      options.history, kLongestHistory);
    return ETLC_OK;
}

etlc_status take(const etlc_options& options, Wish& wish) {
    if (options.path == nullptr && options.text == nullptr)
        return refuse_null("options.path, and options.text with it,");
    wish.check.thresholds_path = text_of(options.thresholds);
    wish.check.fitted_path = text_of(options.fitted);
    wish.check.embedded_path = text_of(options.embedded);
    if (const etlc_status failed = take_settings(options, wish)) return failed;
    if (const etlc_status failed = take_recorder(options, wish)) return failed;
    return take_choices(options, wish);
}

/// Drops findings that concern only users of the generated class.
diag::Sink told_here(const diag::Sink& sink) {
    diag::Sink result;
    for (const diag::Diagnostic& found : sink.sorted())
        if (found.code != diag::Code::macro_elsewhere) result.report(found);
    return result;
}

std::unique_ptr<Session> open(const etlc_options& options, const Wish& wish, source::File& file,
                              diag::Sink& sink) {
    const std::string path = options.path == nullptr ? "spec.etl" : options.path;
    if (options.text != nullptr)
        file = source::File(path, options.text);
    else if (!read_spec(path, file, sink))
        return nullptr;
    auto compiled = compile(file, wish.check, wish.plan, sink);
    if (!compiled) return nullptr;
    sink = told_here(sink);
    return std::make_unique<Session>(
        std::make_shared<const Program>(file, std::move(*compiled), sink), options.history);
}

/// The size of etlc_options in each version of etlc.h.
constexpr std::uint32_t kSizes[ETLC_API_VERSION + 1] = {0,
                                                        offsetof(etlc_options, recorder),
                                                        offsetof(etlc_options, embedded),
                                                        offsetof(etlc_options, embedded),
                                                        offsetof(etlc_options, embedded),
                                                        sizeof(etlc_options),
                                                        sizeof(etlc_options)};

/// Converts the caller's options to those of this version.
etlc_status take_version(const etlc_options* options, etlc_options& own) {
    if (options == nullptr) return refuse_null("options");
    const std::uint32_t version = options->api_version;
    if (version == 0 || version > ETLC_API_VERSION)
        return refuse(ETLC_WRONG_VERSION,
                      "options.api_version is {}, this library is of version {}: begin with "
                      "ETLC_OPTIONS, from the etlc.h of this library",
                      version, ETLC_API_VERSION);
    if (const etlc_status failed = check_size(options->struct_size, kSizes[version], "options"))
        return failed;
    std::memcpy(&own, options, kSizes[version]);
    return ETLC_OK;
}

}  // namespace

}  // namespace etlc::library

using namespace etlc;
using namespace etlc::library;

extern "C" {

const char* etlc_message(void) {
    return Message::here().text();
}

const char* etlc_message_json(void) {
    return Message::here().json();
}

const char* etlc_version(void) {
    return kVersion;
}

etlc_status etlc_open(const etlc_options* options, etlc_session* session) {
    return guarded([&]() -> etlc_status {
        etlc_options own = ETLC_OPTIONS;
        if (const etlc_status failed = take_version(options, own)) return failed;
        if (session == nullptr) return refuse_null("session");
        *session = 0;
        Wish wish;
        if (const etlc_status failed = take(own, wish)) return failed;
        source::File file;
        diag::Sink sink;
        auto opened = open(own, wish, file, sink);
        if (!opened) {
            Message::here().take_diagnostics(diag::render_text(file, sink),
                                             diag::render_json(file, sink));
            return ETLC_REFUSED;
        }
        std::string warnings = diag::render_json(file, sink);
        *session = hold(std::move(opened));
        if (*session == 0) return refuse(ETLC_OUT_OF_MEMORY, "too many sessions are open");
        Message::here().take_warnings(std::move(warnings));
        return ETLC_OK;
    });
}

etlc_status etlc_close(etlc_session session) {
    return with_held(session, [](Held& held) -> etlc_status {
        held.close();
        return ETLC_OK;
    });
}

}  // extern "C"
