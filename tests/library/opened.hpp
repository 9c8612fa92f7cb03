// A session for a test, closed at the end of its scope.
#pragma once

#include <etlc.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace etlc::tests {

/// The inputs of the tests' monitors: an embedding, a scalar, a bool, and narrow embeddings.
inline constexpr const char* kDock = R"(spec dock;
rate 10 Hz;
input z      : f32[3] hold 1;
input charge : f32 in [0, 1];
input stop   : bool;
input half   : f16[2];
input byte   : i8[2] scale 0.5;
input unread : f32;
target bay = [[1, 0, 0], [0, 1, 0]];
target origin = [[0, 0]];
predicate at_bay = min l2(z, bay) <= 0.5;
predicate is_low = charge <= 0.25;
predicate small  = l1(half, origin) + l1(byte, origin) <= 8;
let docked = at_bay && !stop;
monitor returns = G (is_low -> F[0 s, 0.2 s] docked);
restartable monitor visits = F docked;
sliding monitor calm = G[0, 2] small;
)";

class Opened {
public:
    explicit Opened(const etlc_options& options) {
        EXPECT_EQ(etlc_open(&options, &session_), ETLC_OK) << etlc_message();
        etlc_description spec{};
        spec.struct_size = sizeof spec;
        EXPECT_EQ(etlc_describe(session_, &spec), ETLC_OK) << etlc_message();
        verdicts.resize(spec.monitors);
    }
    ~Opened() { etlc_close(session_); }
    Opened(const Opened&) = delete;
    Opened& operator=(const Opened&) = delete;

    operator etlc_session() const { return session_; }  // NOLINT(google-explicit-constructor)
    etlc_status step(const std::vector<etlc_sample>& samples) {
        return etlc_step(session_, samples.data(), samples.size(), verdicts.data(),
                         verdicts.size());
    }

    std::vector<etlc_verdict> verdicts;

private:
    etlc_session session_ = 0;
};

inline etlc_options options_of(const char* text) {
    etlc_options options = ETLC_OPTIONS;
    options.text = text;
    return options;
}

/// Samples of kDock.
struct Seen {
    float z[3] = {1, 0, 0};
    float charge = 1;
    std::uint8_t stop = 0;
    std::uint16_t half[2] = {0x3c00, 0};  // 1, 0
    std::int8_t byte[2] = {2, -2};        // 1, -1

    std::vector<etlc_sample> samples() const {
        return {{z, 3, ETLC_F32},    {&charge, 1, ETLC_F32}, {&stop, 1, ETLC_BOOL},
                {half, 2, ETLC_F16}, {byte, 2, ETLC_I8},     {nullptr, 0, 0}};
    }
};

/// Checks that the call failed with this status, and that its message contains these words.
inline void expect_refused(etlc_status found, etlc_status expected, const std::string& words) {
    EXPECT_EQ(found, expected) << etlc_message();
    EXPECT_NE(std::string(etlc_message()).find(words), std::string::npos)
        << "'" << etlc_message() << "' lacks '" << words << "'";
}

}  // namespace etlc::tests
