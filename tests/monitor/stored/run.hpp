// The output of a monitor on three traces, as words to compare.
#pragma once

#include <cstdint>
#include <cstring>
#include <iterator>
#include <vector>

#include "etlmon/temporal/boolean_verdict.hpp"
#include "etlmon/views.hpp"

namespace trial {

constexpr int kSteps = 400;

struct Sample {
    bool present;
    std::vector<float> z;
};

template <class T>
void keep(std::vector<std::uint32_t>& words, const T& value) {
    static_assert(sizeof value == 4, "");
    std::uint32_t word = 0;
    std::memcpy(&word, &value, sizeof word);
    words.push_back(word);
}
template <class Verdict>
void keep_answers(std::vector<std::uint32_t>& words, const Verdict& v) {
    const bool answers[] = {v.decided(), v.final(), v.unknown(), v.satisfied(), v.violated()};
    words.insert(words.end(), std::begin(answers), std::end(answers));
}
inline void keep(std::vector<std::uint32_t>& words, const etlmon::Verdict& v) {
    keep(words, v.robustness), keep(words, v.lower), keep(words, v.upper);
    keep_answers(words, v);
}
inline void keep(std::vector<std::uint32_t>& words, const etlmon::BooleanVerdict& v) {
    keep_answers(words, v);
}

/// Every verdict, distance and nearest row of every step; a new episode begins halfway.
template <class Inputs, class Monitor>
std::vector<std::uint32_t> run(Monitor& monitor, const std::vector<Sample>& wide,
                               const std::vector<Sample>& middle,
                               const std::vector<Sample>& narrow) {
    std::vector<std::uint32_t> words;
    for (int step = 0; step < kSteps; ++step) {
        const auto at = static_cast<std::size_t>(step);
        if (step == kSteps / 2) monitor.reset();
        Inputs in;
        if (wide[at].present) in.wide = decltype(in.wide)::unchecked(wide[at].z.data());
        if (middle[at].present) in.middle = decltype(in.middle)::unchecked(middle[at].z.data());
        if (narrow[at].present) in.narrow = decltype(in.narrow)::unchecked(narrow[at].z.data());
        in.x = narrow[at].z[0], in.y = narrow[at].z[1];
        const auto v = monitor.step(in);
#define MONITOR(name) keep(words, v.name);
#define PREDICATE(name) \
    keep(words, monitor.distance_##name()), keep(words, monitor.nearest_##name());
#define CONTRAST(name, near, far)                                                           \
    keep(words, monitor.distance_##name()), keep(words, monitor.nearest_##name##_##near()), \
        keep(words, monitor.nearest_##name##_##far());
#include "names.inc"
        keep(words, monitor.missing_steps());
    }
    return words;
}

}  // namespace trial

/// For the class with its target sets in the header.
std::vector<std::uint32_t> run_inlined(const std::vector<trial::Sample>& wide,
                                       const std::vector<trial::Sample>& middle,
                                       const std::vector<trial::Sample>& narrow);
