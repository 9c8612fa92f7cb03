// Counts the allocations of libetlc after a spec is opened: there are none. Specs of all kinds are
// stepped, run, finished, restarted and reset.
#include <etlc.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "all_kinds.hpp"
#include "random_spec.hpp"

namespace {

bool watching = false;
unsigned long allocations = 0;

void count() {
    if (watching) ++allocations;
}

}  // namespace

extern "C" {
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t number, size_t size);
void* __libc_realloc(void* block, size_t size);

void* malloc(size_t size) noexcept {
    count();
    return __libc_malloc(size);
}
void* calloc(size_t number, size_t size) noexcept {
    count();
    return __libc_calloc(number, size);
}
void* realloc(void* block, size_t size) noexcept {
    count();
    return __libc_realloc(block, size);
}
}

namespace {

struct Input {
    etlc_input is{};
    std::vector<float> floats;
    std::vector<uint16_t> halves;
    std::vector<int8_t> bytes;
    uint8_t flag = 0;
};

bool check(etlc_status status) {
    if (status != ETLC_OK) printf("%s\n", etlc_message());
    return status == ETLC_OK;
}

void fill(Input& input, std::mt19937& random) {
    for (float& x : input.floats) x = static_cast<float>(random() % 33) / 4 - 4;
    for (uint16_t& x : input.halves) x = static_cast<uint16_t>(0x3000 + random() % 0x1000);
    for (int8_t& x : input.bytes) x = static_cast<int8_t>(random() % 256);
    input.flag = random() % 2;
    if (!input.floats.empty() && random() % 16 == 0) input.floats[0] = NAN;
}

etlc_sample sample_of(const Input& input, bool is_there) {
    const void* data = &input.flag;
    if (input.is.type == ETLC_F32) data = input.floats.data();
    if (input.is.type == ETLC_F16) data = input.halves.data();
    if (input.is.type == ETLC_I8) data = input.bytes.data();
    return {is_there ? data : nullptr, input.is.dimension, input.is.type};
}

unsigned long incidents = 0;

/// Reads the bytes of all incidents.
bool take_incidents(etlc_session session) {
    uint32_t complete = 0, lost = 0;
    if (!check(etlc_incidents(session, &complete, &lost))) return false;
    incidents += complete;
    for (uint32_t n = 0; n < complete; ++n) {
        const void* bytes = nullptr;
        size_t size = 0;
        if (!check(etlc_incident(session, n, &bytes, &size))) return false;
    }
    return check(etlc_close_incidents(session)) && check(etlc_forget_incidents(session));
}

/// Makes all calls that a program may make after opening. Returns false if a call failed.
bool use(etlc_session session, std::mt19937& random) {
    etlc_description spec{};
    spec.struct_size = sizeof spec;
    if (!check(etlc_describe(session, &spec))) return false;
    std::vector<Input> inputs(spec.inputs);
    for (uint32_t i = 0; i < spec.inputs; ++i) {
        etlc_input& is = inputs[i].is;
        is.struct_size = sizeof is;
        if (!check(etlc_describe_input(session, i, &is))) return false;
        if (is.type == ETLC_F32) inputs[i].floats.resize(is.dimension);
        if (is.type == ETLC_F16) inputs[i].halves.resize(is.dimension);
        if (is.type == ETLC_I8) inputs[i].bytes.resize(is.dimension);
    }
    std::vector<etlc_sample> samples(spec.inputs);
    const std::vector<etlc_column> columns(spec.inputs);
    std::vector<etlc_verdict> verdicts(4 * spec.monitors);
    std::vector<bool> restarts;
    for (uint32_t m = 0; m < spec.monitors; ++m) {
        etlc_monitor monitor{};
        monitor.struct_size = sizeof monitor;
        if (!check(etlc_describe_monitor(session, m, &monitor))) return false;
        restarts.push_back(monitor.restarts != ETLC_NEVER);
    }
    bool good = true;
    watching = true;
    for (int episode = 0; episode < 3 && good; ++episode) {
        for (int step = 0; step < 60 && good; ++step) {
            for (uint32_t i = 0; i < spec.inputs; ++i) {
                fill(inputs[i], random);
                samples[i] = sample_of(inputs[i], random() % 8 != 0);
            }
            good = check(
                etlc_step(session, samples.data(), samples.size(), verdicts.data(), spec.monitors));
            for (uint32_t m = 0; m < spec.monitors && good; ++m)
                if (restarts[m] && random() % 10 == 0) good = check(etlc_restart(session, m));
            for (uint32_t p = 0; p < spec.predicates && good; ++p) {
                etlc_measured measured;
                good = check(etlc_measure(session, p, &measured));
            }
            // A refused call needs no memory either.
            good = good &&
                   etlc_step(session, samples.data(), 99, verdicts.data(), 1) == ETLC_WRONG_NUMBER;
        }
        good = good && check(etlc_run(session, columns.data(), columns.size(), 4, verdicts.data(),
                                      verdicts.size()));
        for (uint32_t n = 0; n <= spec.horizon && good; ++n)
            good = check(etlc_finish(session, verdicts.data(), spec.monitors));
        good = good && check(etlc_reset(session)) && take_incidents(session);
    }
    watching = false;
    return good;
}

bool opens_and_uses(const std::string& text, bool has_lets, std::mt19937& random) {
    etlc_options options = ETLC_OPTIONS;
    options.text = text.c_str();
    options.history = 100;
    options.recorder = "5,3,4";
    options.lets = has_lets ? 1 : 0;
    options.max_state = options.max_code = options.max_work = uint64_t{64} << 20U;
    etlc_session session = 0;
    return check(etlc_open(&options, &session)) && use(session, random) &&
           check(etlc_close(session));
}

}  // namespace

int main() {
    std::mt19937 random(1);
    if (!opens_and_uses(etlc::tests::kAllKinds, true, random)) return 1;
    for (uint64_t seed = 0; seed < 40; ++seed) {
        const etlc::tests::SpecShape& shape =
            etlc::tests::kSmallShapes[seed % std::size(etlc::tests::kSmallShapes)];
        etlc::tests::SpecShape with_restarts = shape;
        with_restarts.restarts = seed % 2 == 0 ? 0.5 : 0;
        if (!opens_and_uses(etlc::tests::random_spec(seed, with_restarts), false, random)) return 1;
    }
    watching = true;  // the counting works
    free(malloc(1));
    watching = false;
    printf("%lu allocations, %lu incidents\n", allocations - 1, incidents);
    return allocations == 1 && incidents > 0 ? 0 : 1;
}
