// Hand-written operators, in floats: robustness only, all samples present, no bounds, no verdict.
// Takes: one robustness per step. Gives: the value of the operator over the last N. Keeps true:
// PlainWindow is the cheapest known on average (van Herk 1992, Gil and Werman 1993), although one
// step in N does the work of all; Rescan is the definition, over all N samples at each step.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>

namespace bench {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct PlainMax {
    using Element = float;
    static constexpr float identity() { return -kInfinity; }
    static float combine(float older, float newer) { return older < newer ? newer : older; }
};

struct PlainMin {
    using Element = float;
    static constexpr float identity() { return kInfinity; }
    static float combine(float older, float newer) { return newer < older ? newer : older; }
};

inline float larger(float a, float b) {
    return PlainMax::combine(a, b);
}
inline float smaller(float a, float b) {
    return PlainMin::combine(a, b);
}

/// f U g over a range of positions, evaluated at the first.
struct PlainUntil {
    struct Element {
        float value, guard;
    };
    static constexpr Element identity() { return {-kInfinity, kInfinity}; }
    static Element combine(Element older, Element newer) {
        return {larger(older.value, smaller(older.guard, newer.value)),
                smaller(older.guard, newer.guard)};
    }
};

template <class Monoid, uint32_t N>
class PlainWindow {
public:
    using Element = typename Monoid::Element;
    void reset() {
        at_ = 0;
        prefix_ = Monoid::identity();
        for (Element& element : elements_) element = Monoid::identity();
    }
    Element push(Element element) {
        prefix_ = Monoid::combine(prefix_, element);
        elements_[at_++] = element;
        if (at_ == N) {
            const Element whole = prefix_;
            for (uint32_t i = N - 1; i > 0; --i)
                elements_[i - 1] = Monoid::combine(elements_[i - 1], elements_[i]);
            at_ = 0;
            prefix_ = Monoid::identity();
            return whole;
        }
        return Monoid::combine(elements_[at_], prefix_);
    }

private:
    uint32_t at_;
    Element prefix_;
    Element elements_[N];  ///< up to at_ this block's samples, from there the suffixes of the block
                           ///< before
};

template <uint32_t N>
class PlainDelay {
public:
    void reset(float fill) {
        at_ = 0;
        for (float& value : values_) value = fill;
    }
    float push(float value) {
        const float past = values_[at_];
        values_[at_] = value;
        at_ = at_ + 1 == N ? 0 : at_ + 1;
        return past;
    }

private:
    uint32_t at_;
    float values_[N];
};

template <class Monoid, uint32_t N>
class Rescan {
public:
    using Element = typename Monoid::Element;
    void reset() {
        at_ = 0;
        for (Element& element : elements_) element = Monoid::identity();
    }
    Element push(Element element) {
        elements_[at_] = element;
        at_ = at_ + 1 == N ? 0 : at_ + 1;
        Element all = Monoid::identity();
        for (uint32_t i = at_; i < N; ++i) all = Monoid::combine(all, elements_[i]);
        for (uint32_t i = 0; i < at_; ++i) all = Monoid::combine(all, elements_[i]);
        return all;
    }

private:
    uint32_t at_;
    Element elements_[N];
};

}  // namespace bench
