// Proves that a window over pairs is two windows, of the lows and of the highs, whichever samples
// are missing. Takes: the runtime's PairWindow, which stores the highs only where they differ.
// Gives: whether it is. Keeps true: the proof is by induction over steps. The state between two
// steps is known up to what no later step reads: where in each block the ends part, the slot of the
// next step, and any elements at all; from every such state that can occur, one step is taken on
// symbols, with and without a difference of the new ends, and leads to such a state again.
#pragma once

#include <string.h>

#include <memory>
#include <set>
#include <tuple>
#include <vector>

// The state of a window is its own.
#define private public
#include "etlmon/temporal/window.hpp"
#undef private
#include "etlmon/past/count.hpp"
#include "etlmon/temporal/handover.hpp"
#include "etlmon/temporal/sourced.hpp"

namespace etlprove {

template <template <class> class Operator, class Value, uint32_t Length>
class PairProof {
    using Pair = etlmon::PairWindow<Operator, Value, Length>;
    using End = typename etlmon::Lattice<Value>::End;
    using Ends = Operator<End>;
    using Element = typename Ends::Element;
    static constexpr uint32_t kNowhere = etlmon::Parting::kNowhere;
    static constexpr uint32_t kSlots = etlmon::window_elements(Length);
    static constexpr uint32_t kPlaces = Length & ~uint32_t{1};

public:
    bool run() {
        if (Length == 1) return true;
        begin();
        open_.push_back({0, kNowhere, kNowhere, kNowhere});
        seen_.insert(open_[0]);
        while (!open_.empty()) {
            const At at = open_.back();
            open_.pop_back();
            if (!step(at, false) || !step(at, true)) return false;
        }
        return true;
    }

private:
    /// The slot of the next step, and the first slot of each block whose ends differ.
    using At = std::tuple<uint32_t, uint32_t, uint32_t, uint32_t>;

    Element lows_[kSlots], highs_[kSlots], unread_[kSlots], low_, high_;
    std::unique_ptr<Pair> pair_ = std::make_unique<Pair>();
    Element two_lows_[kSlots], two_highs_[kSlots];
    std::vector<At> open_;
    std::set<At> seen_;
    Place next_ = kFirstSample;

    /// Returns an element of variables that nothing else has.
    Element fresh() {
        Element element;
        memset(static_cast<void*>(&element), 0, sizeof element);
        for (size_t at = 0; at < sizeof element; at += sizeof(End)) {
            const End end = etlmon::Key::of(diagrams().variable(next_++));
            memcpy(reinterpret_cast<unsigned char*>(&element) + at, &end, sizeof end);
        }
        return element;
    }

    void begin() {
        for (uint32_t i = 0; i < kSlots; ++i) {
            lows_[i] = fresh();
            highs_[i] = fresh();
            unread_[i] = fresh();
        }
        low_ = fresh();
        high_ = fresh();
    }

    static bool same(const Element& a, const Element& b) { return memcmp(&a, &b, sizeof a) == 0; }

    /// Whether the highs hold the element of a slot of the storage; elsewhere the lows do.
    static bool held_apart(const At& at, uint32_t i) {
        const auto [cursor, newest, middle, oldest] = at;
        if (i == 0) return middle != kNowhere;
        if (i == 1) return newest != kNowhere;
        const uint32_t slot = i - 2;
        const bool in_first = slot < kPlaces / 2, runs_in_first = cursor < kPlaces / 2;
        if (in_first == runs_in_first) return slot < cursor ? slot >= newest : oldest != kNowhere;
        // The table of the middle block is built from its end while the newest block fills.
        return middle != kNowhere && (slot >= middle || slot + cursor + 1 >= kPlaces);
    }

    bool step(const At& at, bool parts) {
        Pair& pair = *pair_;
        pair.cursor_ = std::get<0>(at);
        pair.parting_.newest = std::get<1>(at);
        pair.parting_.middle = std::get<2>(at);
        pair.parting_.oldest = std::get<3>(at);
        for (uint32_t i = 0; i < kSlots; ++i) {
            const bool apart = held_apart(at, i);
            pair.lows_[i] = two_lows_[i] = lows_[i];
            pair.highs_[i] = apart ? highs_[i] : unread_[i];
            two_highs_[i] = apart ? highs_[i] : lows_[i];
        }
        const Element high = parts ? high_ : low_;
        uint32_t cursor = std::get<0>(at), other = cursor;
        const Element of_lows = etlmon::window_push<Ends>(two_lows_, cursor, Length, low_);
        const Element of_highs = etlmon::window_push<Ends>(two_highs_, other, Length, high);
        using etlmon::high_of;
        using etlmon::low_of;
        using etlmon::pair_of;
        const auto found = pair.push(pair_of(low_, high));
        return same(low_of(found), of_lows) && same(high_of(found), of_highs) &&
               pair.cursor_ == cursor && follows();
    }

    /// Whether the state is one of those that the proof is about; it is then open.
    bool follows() {
        const Pair& pair = *pair_;
        const At at{pair.cursor_, pair.parting_.newest, pair.parting_.middle, pair.parting_.oldest};
        for (uint32_t i = 0; i < kSlots; ++i)
            if (!same(pair.lows_[i], two_lows_[i]) ||
                !same(held_apart(at, i) ? pair.highs_[i] : pair.lows_[i], two_highs_[i]))
                return false;
        if (seen_.insert(at).second) open_.push_back(at);
        return true;
    }
};

/// Longer windows have too many states.
constexpr uint32_t kLongestPair = 160;

struct WindowOfClass {
    uint32_t length;
    bool (*is_two_windows)();  ///< null if it is too long
};

template <template <class> class Operator, class Value, uint32_t Length>
bool is_two_windows() {
    return std::make_unique<PairProof<Operator, Value, Length>>()->run();
}
template <template <class> class Operator, class Value, uint32_t Length>
void add(std::vector<WindowOfClass>& windows) {
    if constexpr (Length <= kLongestPair)
        windows.push_back({Length, is_two_windows<Operator, Value, Length>});
    else
        windows.push_back({Length, nullptr});
}

/// Adds the window of a member, if it is one over pairs.
template <class Member>
void add_window(std::vector<WindowOfClass>&, const Member&) {}
template <template <class> class Operator, class Value, uint32_t Length>
void add_window(std::vector<WindowOfClass>& windows,
                const etlmon::Window<Operator<Value>, Length>&) {
    if constexpr (!etlmon::detail::Same<Value, etlmon::Truth>::value)
        add<Operator, Value, Length>(windows);
}
template <class Value, uint32_t n, uint32_t Length>
void add_window(std::vector<WindowOfClass>& windows, const etlmon::AtLeast<Value, n, Length>&) {
    if constexpr (!etlmon::detail::Same<Value, etlmon::Truth>::value &&
                  !etlmon::keeps_order(n, Length))
        add<Nth<n>::template Of, Value, Length>(windows);
}
template <class Value, uint32_t n, uint32_t Length>
void add_window(std::vector<WindowOfClass>& windows, const etlmon::AllBut<Value, n, Length>&) {
    if constexpr (!etlmon::detail::Same<Value, etlmon::Truth>::value &&
                  !etlmon::keeps_order(n, Length))
        add<Nth<n>::template Of, Value, Length>(windows);
}

}  // namespace etlprove
