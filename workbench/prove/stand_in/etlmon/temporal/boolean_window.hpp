// SPDX-License-Identifier: MIT
// Stands in for the runtime's boolean_window.hpp when `etlc prove` compiles a class. Takes: a truth
// a step. Gives: the results of the runtime's classes. Keeps true: the state is the last truths
// alone, so that it is the same on every way through a step.
#pragma once

#include "etlmon/temporal/delay.hpp"
#include "etlmon/temporal/monoid.hpp"
#include "etlmon/temporal/truth.hpp"
#include "etlmon/temporal/window.hpp"

namespace etlprove {

/// The last values, the oldest first. The runtime's classes work after a reset() only.
template <class Element, uint32_t Length>
class Last {
public:
    constexpr void reset(Element fill) noexcept {
        for (Element& value : values_) value = fill;
        is_reset_ = kReset;
    }
    /// Returns the value that leaves.
    Element push(Element value) noexcept {
        if (is_reset_ != kReset) stop(kNotReset);
        const Element oldest = values_[0];
        for (uint32_t i = 1; i < Length; ++i) values_[i - 1] = values_[i];
        values_[Length - 1] = value;
        return oldest;
    }
    const Element& operator[](uint32_t at) const noexcept { return values_[at]; }

private:
    static constexpr uint32_t kReset = 1;

    Element values_[Length];
    uint32_t is_reset_;
};

template <class Monoid, uint32_t Length>
class TruthWindow {
public:
    using Element = typename Monoid::Element;

    constexpr void reset() noexcept { last_.reset(Monoid::identity()); }
    Element push(Element value) noexcept {
        last_.push(value);
        Element all = last_[Length - 1];
        for (uint32_t i = Length - 1; i-- > 0;) all = Monoid::combine(last_[i], all);
        return all;
    }

private:
    Last<Element, Length> last_;
};

}  // namespace etlprove

namespace etlmon {
inline namespace ETLMON_BUILD {

template <template <class> class Operator, uint32_t Length>
class Window<Operator<Truth>, Length> : public etlprove::TruthWindow<Operator<Truth>, Length> {};
template <uint32_t Length>
class Delay<Truth, Length> : public etlprove::Last<Truth, Length> {};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
