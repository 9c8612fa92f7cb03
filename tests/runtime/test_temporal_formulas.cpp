// Compares formulas built from windows and delays, as in generated monitors, with their definitions
// on every prefix: offsets of intervals, bounded until over a delayed stream with its end, the
// pending half of G(p -> F[0,w] q).
#include <gtest/gtest.h>

#include <algorithm>

#include "temporal_streams.hpp"

namespace {

using etlmon::Key;
using etlmon::Span;
using temporal::random_streams;
using temporal::Streams;

/// rho(G(p -> F[0,w] q), 0, i), cut at the prefix; g is q, f is !p.
Key bounded_response(const Streams<Key>& s, size_t w, size_t i) {
    Key rho = etlmon::kTop;
    for (size_t k = 0; k <= i; ++k) {
        Key response = s.f[k];
        for (size_t j = k; j <= std::min(k + w, i); ++j)
            response = etlmon::max_of(response, s.g[j]);
        rho = etlmon::min_of(rho, response);
    }
    return rho;
}

template <uint32_t W>
void expect_bounded_response() {
    etlmon::Window<etlmon::Greatest<Key>, W + 1> answered;
    etlmon::Delay<Key, W> not_p;
    etlmon::Window<etlmon::Trigger<Key>, W> pending;
    answered.reset();
    not_p.reset(etlmon::kTop);
    pending.reset();
    Key settled = etlmon::kTop;
    Key unbounded = etlmon::kTop;
    const Streams<Key> s = random_streams<Key>(6 * W + 40, W);
    for (size_t i = 0; i < s.g.size(); ++i) {
        settled =
            etlmon::min_of(settled, etlmon::max_of(not_p.push(s.f[i]), answered.push(s.g[i])));
        const Key open = pending.push({etlmon::max_of(s.f[i], s.g[i]), s.g[i]}).value;
        unbounded = etlmon::max_of(etlmon::min_of(unbounded, s.f[i]), s.g[i]);
        const Key rho = bounded_response(s, W, i);
        ASSERT_EQ(etlmon::min_of(settled, open), rho) << W << ' ' << i;
        ASSERT_EQ(etlmon::min_of(settled, unbounded), rho) << W << ' ' << i;
    }
}

TEST(TemporalFormula, PendingHalfOfABoundedResponse) {
    expect_bounded_response<1>();
    expect_bounded_response<2>();
    expect_bounded_response<3>();
    expect_bounded_response<10>();
    expect_bounded_response<51>();
}

/// f S[a,b] g at position k, by its definition.
Key since_in(const Streams<Key>& s, size_t a, size_t b, size_t k) {
    Key rho = etlmon::kBottom;
    for (size_t j = k < b ? 0 : k - b; j + a <= k; ++j) {
        Key value = s.g[j];
        for (size_t m = j + 1; m <= k; ++m) value = etlmon::min_of(value, s.f[m]);
        rho = etlmon::max_of(rho, value);
    }
    return rho;
}

template <uint32_t A, uint32_t B>
void expect_since_with_offset() {
    etlmon::Window<etlmon::Since<Key>, B - A + 1> since;
    etlmon::Delay<Key, A> offset;
    etlmon::Window<etlmon::Least<Key>, A> held;
    since.reset();
    offset.reset(etlmon::kBottom);
    held.reset();
    const Streams<Key> s = random_streams<Key>(5 * B + 20, 100 * A + B);
    for (size_t k = 0; k < s.g.size(); ++k) {
        const Key earlier = offset.push(since.push({s.g[k], s.f[k]}).value);
        ASSERT_EQ(etlmon::min_of(earlier, held.push(s.f[k])), since_in(s, A, B, k))
            << A << ' ' << B << ' ' << k;
    }
}

TEST(TemporalFormula, SinceWithAnOffset) {
    expect_since_with_offset<1, 1>();
    expect_since_with_offset<1, 6>();
    expect_since_with_offset<4, 9>();
    expect_since_with_offset<7, 30>();
}

/// f U[a,b] g at position k of a trace that ends after `last`, by its definition.
Key until_in(const Streams<Key>& s, size_t a, size_t b, size_t k, size_t last) {
    Key rho = etlmon::kBottom;
    for (size_t j = k + a; j <= std::min(k + b, last); ++j) {
        Key value = s.g[j];
        for (size_t m = k; m < j; ++m) value = etlmon::min_of(value, s.f[m]);
        rho = etlmon::max_of(rho, value);
    }
    return rho;
}

/// Verdicts come B steps late; after the end, identity elements replace the positions that never
/// came.
template <uint32_t A, uint32_t B>
void expect_until_with_its_end() {
    etlmon::Window<etlmon::Until<Key>, B - A + 1> until;
    etlmon::Delay<Key, B - A + 1> before;
    etlmon::Window<etlmon::Least<Key>, A> held;
    until.reset();
    before.reset(etlmon::kTop);
    held.reset();
    const Streams<Key> s = random_streams<Key>(4 * B + 11, 100 * A + B);
    const size_t length = s.g.size();
    for (size_t i = 0; i < length + B; ++i) {
        const Span<Key> element =
            i < length ? Span<Key>{s.g[i], s.f[i]} : etlmon::Until<Key>::identity();
        const Key from_a = until.push(element).value;            // over [i - B + A, i]
        const Key lead = held.push(before.push(element.guard));  // min of f over [i - B, i - B + A)
        if (i < B) continue;
        ASSERT_EQ(etlmon::min_of(lead, from_a), until_in(s, A, B, i - B, length - 1))
            << A << ' ' << B << ' ' << i;
    }
}

TEST(TemporalFormula, UntilWithAnOffsetAndItsEnd) {
    expect_until_with_its_end<1, 1>();
    expect_until_with_its_end<1, 5>();
    expect_until_with_its_end<3, 8>();
    expect_until_with_its_end<12, 40>();
}

/// Four windows over one signal, the longer ones built from the shorter.
TEST(TemporalFormula, OneSignalUnderManyWindows) {
    etlmon::Window<etlmon::Greatest<Key>, 10> to10;
    etlmon::Widening<etlmon::Greatest<Key>, 10, 20> to20;
    etlmon::Widening<etlmon::Greatest<Key>, 20, 33> to33;
    etlmon::Widening<etlmon::Greatest<Key>, 33, 66> to66;
    to10.reset();
    to20.reset();
    to33.reset();
    to66.reset();
    const Streams<Key> s = random_streams<Key>(500, 3);
    const auto last = [&](size_t n, size_t i) {
        return temporal::GreatestCase<Key>::defined(s, i + 1 < n ? 0 : i + 1 - n, i);
    };
    for (size_t i = 0; i < s.g.size(); ++i) {
        const Key of10 = to10.push(s.g[i]);
        const Key of20 = to20.push(of10);
        const Key of33 = to33.push(of20);
        const Key of66 = to66.push(of33);
        ASSERT_EQ(of10, last(10, i));
        ASSERT_EQ(of20, last(20, i));
        ASSERT_EQ(of33, last(33, i));
        ASSERT_EQ(of66, last(66, i));
    }
}

}  // namespace
