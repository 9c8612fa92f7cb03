// Checks a retargetable class for retarget_test.sh, on random traces.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "docking.hpp"
#include "first.hpp"
#include "second.hpp"
#include "twin.hpp"

#include "first.inc"
#include "longer.inc"
#include "second.inc"
#include "third.inc"

namespace {

using docking::Monitor;
using docking::Params;
using etlmon::ParamsState;
using etlmon::Past;

void require(bool holds, const char* what) {
    if (holds) return;
    std::printf("FAILED: %s\n", what);
    std::exit(1);
}

double wide(float x) {
    return static_cast<double>(x);
}

/// Makes the samples of a step, some of them missing; near the targets, so that predicates change.
struct Sample {
    float z[32], w[7], v[33], x, y, charge;
    bool has_z, has_w, has_v, open, has_called, called;

    template <class Inputs>
    Inputs as() const {
        Inputs in;
        if (has_z) in.z = z;
        if (has_w) in.w = w;
        if (has_v) in.v = v;
        in.x = x;
        in.y = y;
        in.charge = charge;
        in.open = open;
        if (has_called) in.called = called;
        return in;
    }
};

class Trace {
public:
    Trace(unsigned seed, double missing) : random_(seed), missing_(missing) {}

    const Sample& next() {
        std::normal_distribution<float> normal;
        if (random_() % 6 == 0)
            for (auto* x : {&scale_[0], &scale_[1], &scale_[2]}) *x = std::abs(normal(random_));
        const auto fill = [&](float* to, std::size_t n, float scale) {
            for (std::size_t i = 0; i < n; ++i) to[i] = scale * normal(random_);
        };
        fill(now_.z, 32, 1.2F * scale_[0]);
        fill(now_.w, 7, scale_[1]);
        fill(now_.v, 33, scale_[2]);
        now_.x = scale_[0] * normal(random_);
        now_.y = there() ? normal(random_) : etlmon::kMissing;
        now_.charge = std::min(std::abs(normal(random_)), 1.875F);  // never out of range
        now_.has_z = there();
        now_.has_w = there();
        now_.has_v = there();
        now_.open = random_() % 2 == 0;
        now_.has_called = there();
        now_.called = random_() % 4 != 0;
        return now_;
    }
    unsigned one_of(unsigned n) { return static_cast<unsigned>(random_() % n); }

private:
    bool there() { return std::uniform_real_distribution<>(0, 1)(random_) >= missing_; }

    std::mt19937 random_;
    double missing_;
    float scale_[3] = {1, 1, 1};
    Sample now_{};
};

template <class A, class B>
bool same_bits(const A& a, const B& b) {
    static_assert(sizeof(A) == sizeof(B), "what is compared is alike");
    return std::memcmp(&a, &b, sizeof a) == 0;
}

const Params& parameters(unsigned which) {
    static const Params kAll[] = {Params(first_bytes, sizeof first_bytes),
                                  Params(second_bytes, sizeof second_bytes),
                                  Params(third_bytes, sizeof third_bytes)};
    return kAll[which];
}

/// The same numbers as constants of a class give the same measurements to the bit, and the
/// retargetable class is never final earlier.
template <class Plain, class PlainInputs>
void compare_with_plain(unsigned which) {
    for (unsigned seed = 0; seed < 60; ++seed) {
        Trace trace(seed, 0);
        Monitor monitor(parameters(which));
        Plain plain;
        bool final_together = true;
        for (int step = 0; step < 60; ++step) {
            const Sample& sample = trace.next();
            const auto one = monitor.step(sample.as<docking::Inputs>());
            const auto other = plain.step(sample.as<PlainInputs>());
#define PREDICATE(p)                                                                      \
    require(same_bits(monitor.distance_##p(), plain.distance_##p()), "distances of " #p); \
    require(same_bits(monitor.threshold_##p(), plain.threshold_##p()), "thresholds of " #p);
            PREDICATE(at_bay)
            PREDICATE(at_wall)
            PREDICATE(among)
            PREDICATE(apart)
            PREDICATE(weighted)
            PREDICATE(formed)
            PREDICATE(through)
#undef PREDICATE
            require(monitor.nearest_at_wall() == plain.nearest_at_wall(), "nearest rows");
            const auto a = named(one);
            const auto b = named(other);
            for (unsigned m = 0; m < 13; ++m) {
                const etlmon::Verdict& x = a.entries[m].verdict;
                const etlmon::Verdict& y = b.entries[m].verdict;
                if (!same_bits(x.robustness, y.robustness))
                    std::printf("%s at step %d: %g, %g\n", a.entries[m].name, step,
                                wide(x.robustness), wide(y.robustness));
                require(same_bits(x.robustness, y.robustness), "robustness");
                require(x.satisfied() == y.satisfied() && x.violated() == y.violated(), "status");
                require(!x.final() || y.final(), "final of a retargetable class alone");
                if (!y.decided()) continue;
                require(x.lower <= y.lower && y.upper <= x.upper, "bounds");
                final_together = final_together && x.final() == y.final();
            }
        }
        require(final_together, "a verdict is final later than that of a plain class");
    }
}

template <class Atoms>
twin::Inputs as_scalars(const Atoms& now, const Sample& sample) {
    twin::Inputs in;
    in.open = sample.open;
    if (sample.has_called) in.called = sample.called;
    const auto number = [](etlmon::Value value) {
        return value.low == value.high ? etlmon::float_of(value.low) : etlmon::kMissing;
    };
#define PREDICATE(p) in.of_##p = number(now.p);
#include "predicates.inc"
#undef PREDICATE
    return in;
}

template <class A, class B>
void require_same(const A& a, const B& b, const char* what) {
    const auto one = named(a);
    const auto other = named(b);
    for (unsigned m = 0; m < sizeof one.entries / sizeof one.entries[0]; ++m) {
        if (same_bits(one.entries[m].verdict, other.entries[m].verdict)) continue;
        const auto& x = one.entries[m].verdict;
        const auto& y = other.entries[m].verdict;
        std::printf("%s: %g [%g, %g] %u, %g [%g, %g] %u\n", one.entries[m].name, wide(x.robustness),
                    wide(x.lower), wide(x.upper), x.status, wide(y.robustness), wide(y.lower),
                    wide(y.upper), y.status);
        require(false, what);
    }
}

/// A kept past: each step counts as measured then, and no final verdict is taken back under other
/// parameters.
void swap_and_keep(unsigned seed) {
    Trace trace(seed, seed % 3 == 0 ? 0 : 0.1);
    Monitor monitor(parameters(trace.one_of(3)));
    twin::Monitor twin;
    docking::Verdicts before;
    for (int step = 0; step < 80; ++step) {
        if (trace.one_of(5) == 0) {
            const ParamsState state = monitor.retarget(parameters(trace.one_of(3)), Past::kept);
            require(state == ParamsState::ready, "parameters are taken");
        }
        if (trace.one_of(20) == 0) {
            monitor.restart_again();
            twin.restart_again();
            before.again = etlmon::Verdict();
        }
        const Sample& sample = trace.next();
        const Monitor::Atoms now = monitor.measure(sample.as<docking::Inputs>());
        const auto verdicts = monitor.judge(now);
        require_same(verdicts, twin.step(as_scalars(now, sample)), "a kept past");
        for (unsigned m = 0; m < 8; ++m) {  // monitors that never restart by themselves
            const etlmon::Verdict& old = named(before).entries[m].verdict;
            const etlmon::Verdict& next = named(verdicts).entries[m].verdict;
            if (old.final())
                require(next.final() && old.satisfied() == next.satisfied() &&
                            old.violated() == next.violated(),
                        "what was final changed");
        }
        before = verdicts;
    }
    for (int step = 0; step < 12; ++step)
        require_same(monitor.finish(), twin.finish(), "a kept past, at its end");
}

/// With a forgotten past it equals a new monitor.
void swap_and_forget(unsigned seed) {
    Trace trace(seed, 0.05);
    Monitor monitor(parameters(0));
    for (int step = 0; step < 20; ++step) monitor.step(trace.next().as<docking::Inputs>());
    require(
        monitor.retarget(second_bytes, sizeof second_bytes, Past::forgotten) == ParamsState::ready,
        "bytes are taken");
    Monitor fresh(parameters(1));
    for (int step = 0; step < 40; ++step) {
        const auto in = trace.next().as<docking::Inputs>();
        require_same(monitor.step(in), fresh.step(in), "a forgotten past");
    }
}

/// Every flipped bit, and every wrong length or address, is refused, and the monitor continues
/// unchanged.
void refuse() {
    constexpr std::size_t kSize = Params::kSize;
    static_assert(kSize == sizeof first_bytes, "the class states its bytes");
    auto* place = static_cast<unsigned char*>(std::aligned_alloc(64, kSize + 128));
    Monitor monitor(parameters(0));
    Monitor untouched(parameters(0));
    Trace trace(7, 0);
    const auto expect = [&](const unsigned char* bytes, std::size_t size, ParamsState why) {
        const ParamsState state = monitor.retarget(bytes, size, Past::forgotten);
        require(state == why, "the reason of a refusal");
        require(state != ParamsState::ready && std::strlen(etlmon::words(state)) > 10,
                "a reason in words");
    };
    std::mt19937 random(3);
    for (int n = 0; n < 4000; ++n) {
        std::memcpy(place, second_bytes, kSize);
        const std::size_t bit = n < 512 ? static_cast<std::size_t>(n) : random() % (8 * kSize);
        place[bit / 8] = static_cast<unsigned char>(place[bit / 8] ^ (1U << (bit % 8)));
        const std::size_t byte = bit / 8;
        expect(place, kSize,
               byte < 8    ? ParamsState::not_params
               : byte < 12 ? ParamsState::wrong_version
               : byte < 16 ? ParamsState::wrong_size
               : byte < 24 ? ParamsState::wrong_shape
               : byte < 32 ? ParamsState::wrong_encoder
                           : ParamsState::wrong_checksum);
        if (n % 100 != 0) continue;
        const auto in = trace.next().as<docking::Inputs>();
        require_same(monitor.step(in), untouched.step(in), "a refusal changed something");
    }
    std::memcpy(place, second_bytes, kSize);
    expect(nullptr, kSize, ParamsState::absent);
    expect(place, kSize - 64, ParamsState::wrong_size);
    expect(place, kSize + 64, ParamsState::wrong_size);
    expect(place, 63, ParamsState::not_params);
    expect(place, 0, ParamsState::not_params);
    std::memcpy(place + 4, second_bytes, kSize);
    expect(place + 4, kSize, ParamsState::misaligned);
    expect(longer_bytes, sizeof longer_bytes, ParamsState::wrong_shape);

    // Invalid numbers, with a matching checksum.
    const auto with = [&](std::size_t at, float number) {
        std::memcpy(place, second_bytes, kSize);
        std::memcpy(place + 4 * at, &number, sizeof number);
        const std::uint64_t sum = etlmon::detail::params_checksum(place, kSize);
        std::memcpy(place + 56, &sum, sizeof sum);
    };
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float inf = std::numeric_limits<float>::infinity();
    const std::size_t places[] = {docking::thresholds::at_bay, docking::thresholds::comparison_1,
                                  docking::constants::apart_1, docking::targets::bay,
                                  docking::targets::wall_unit, docking::targets::wall_weights,
                                  docking::projections::P + 7};
    for (const std::size_t at : places) {
        for (const float number : {nan, inf, -inf}) {
            with(at, number);
            expect(place, kSize, ParamsState::bad_number);
        }
        with(at, 0.25F);
        const bool unit = at == docking::targets::wall_unit;
        require((monitor.retarget(place, kSize, Past::kept) == ParamsState::ready) == !unit,
                "a number that can be is taken, a row of another length is not");
        require(monitor.retarget(parameters(0), Past::kept) == ParamsState::ready, "back again");
    }
    with(docking::thresholds::at_bay, -0.5F);
    expect(place, kSize, ParamsState::bad_number);
    with(docking::targets::wall_weights, 0);
    expect(place, kSize, ParamsState::bad_number);
    with(docking::targets::origin_weights + 1, 0.25F);  // no longer symmetric
    expect(place, kSize, ParamsState::bad_number);
    std::free(place);
}

/// Before it has parameters everything is unknown; from then on it judges later steps.
void begin_without() {
    Trace trace(1, 0);
    Monitor monitor;
    require(!monitor.ready() && std::isnan(monitor.threshold_at_bay()), "no parameters yet");
    require(monitor.origin().spec == 0, "made from nothing");
    for (int step = 0; step < 5; ++step) {
        const auto verdicts = monitor.step(trace.next().as<docking::Inputs>());
        for (const auto& [name, verdict] : named(verdicts))
            require(!verdict.alarm() && !verdict.fulfilled(), name);
    }
    require(monitor.missing_steps() == 5, "steps without parameters are counted");
    require(monitor.retarget(parameters(0), Past::forgotten) == ParamsState::ready, "some");
    require(monitor.ready() && monitor.missing_steps() == 0, "a new episode");
    require(monitor.origin().spec == first::Monitor::kSpecHash &&
                monitor.origin().data == first::Monitor::kDataHash,
            "what parameters were made from");
}

/// The counts equal those of two monitors stepped side by side.
void try_out(unsigned seed) {
    Trace trace(seed, 0.05);
    docking::Shadow shadow{Monitor(parameters(0))};
    Monitor one(parameters(0));
    const Past past = seed % 2 == 0 ? Past::kept : Past::forgotten;
    for (int step = 0; step < 10; ++step) {
        const auto in = trace.next().as<docking::Inputs>();
        require_same(shadow.step(in), one.step(in), "without a trial");
    }
    require(!shadow.promote(), "nothing to promote");
    const Params none;
    require(shadow.try_out(none, past) == ParamsState::absent && !shadow.on_trial(), "refused");
    require(shadow.try_out(parameters(1), past) == ParamsState::ready, "a trial");
    Monitor other = one;
    require(other.retarget(parameters(1), past) == ParamsState::ready, "the same beside it");
    std::vector<etlmon::ShadowCount> counts(13);
    for (int step = 0; step < 60; ++step) {
        const auto in = trace.next().as<docking::Inputs>();
        const auto a = one.step(in);
        const auto b = other.step(in);
        require_same(shadow.step(in), a, "the active one answers");
        for (unsigned m = 0; m < 13; ++m) {
            const auto& x = named(a).entries[m].verdict;
            const auto& y = named(b).entries[m].verdict;
            ++counts[m].steps;
            counts[m].status += x.status != y.status ? 1 : 0;
            counts[m].alarm += x.alarm() != y.alarm() ? 1 : 0;
        }
    }
    unsigned differences = 0;
    for (unsigned m = 0; m < 13; ++m) {
        require(same_bits(shadow.count_of(m), counts[m]), "counts of two side by side");
        differences += counts[m].status;
    }
    require(differences > 0, "the parameters differ in something");
    require(shadow.promote() && !shadow.on_trial(), "promoted");
    for (int step = 0; step < 20; ++step) {
        const auto in = trace.next().as<docking::Inputs>();
        require_same(shadow.step(in), other.step(in), "what was promoted goes on");
    }
}

}  // namespace

int main() {
    for (unsigned which = 0; which < 3; ++which)
        require(parameters(which).ready(), etlmon::words(parameters(which).state()));
    compare_with_plain<first::Monitor, first::Inputs>(0);
    compare_with_plain<second::Monitor, second::Inputs>(1);
    for (unsigned seed = 0; seed < 400; ++seed) swap_and_keep(seed);
    for (unsigned seed = 0; seed < 20; ++seed) swap_and_forget(seed);
    refuse();
    begin_without();
    for (unsigned seed = 0; seed < 20; ++seed) try_out(seed);
    return 0;
}
