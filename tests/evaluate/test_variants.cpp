// Compares the figures of variants with those of files that plain loops write: the same frames in
// the order of the variant.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "evaluated.hpp"

namespace etlc::tests {
namespace {

using episodes::Variant;
using Rows = std::vector<std::string>;

/// The labels of p come from an array, those of q from a formula over the past.
const std::string kVaried = R"(
    spec t;
    input u, w : f32;
    input y : f32 hold 1;
    input z : f32[2], stale after 2;
    target far = [[9, 9]];
    predicate p = u > 0;
    predicate q = w <= 0.25;
    predicate r = l2(z, far) > 12;
    truth q = O[0, 2] y > 0.25;
    truth r = y > 0;
    monitor sequence = F (p && F q);
    monitor reach = F (p && r);
    monitor safe = G (p -> F[0, 3] q);
    monitor response = G (q -> H[0, 3] !p) || r U p;
    sliding monitor close = F[0, 2] (p || r);
)";

struct Rehearsal {
    Rows rows;
    std::vector<char> p;  ///< '0', '1' or '?', the truth of p
    std::vector<char> q;
    std::vector<char> r;

    std::string csv(const std::vector<std::size_t>& order) const {
        std::string text = "u,w,y,z[0],z[1],truth.p\n";
        for (const std::size_t t : order) text += rows[t];
        return text;
    }
};

Rehearsal random_rehearsal(std::mt19937& random) {
    Rehearsal result;
    const auto number = [&] { return static_cast<double>(random() % 129) / 64 - 1.01; };
    const std::size_t steps = 1 + random() % 14;
    char p = '0';
    std::string z = "1,2";
    std::vector<char> above;  // y > 0.25, with the hold
    std::string held = "?";
    for (std::size_t t = 0; t < steps; ++t) {
        if (random() % 4 == 0) p = p == '0' ? '1' : '0';
        const char label = random() % 6 == 0 ? '?' : p;
        if (random() % 2 == 0) z = fmt::format("{},{}", number(), number());
        const bool missing = random() % 4 == 0;
        const double y = number();
        result.rows.push_back(fmt::format("{},{},{},{},{}\n", number(), number(),
                                          missing ? "" : fmt::format("{}", y), z,
                                          label == '?' ? "" : std::string(1, label)));
        result.p.push_back(label);
        // hold 1: one missing sample in a row is the last one.
        const bool is_held = missing && t > 0 && held != "?" && held != "used";
        const std::string value = !missing ? fmt::format("{}", y) : is_held ? held : "?";
        held = !missing ? value : "used";
        const auto truth = [&](double limit) {
            return value == "?" ? '?' : std::stod(value) > limit ? '1' : '0';
        };
        above.push_back(truth(0.25));
        result.r.push_back(truth(0));
        char once = '0';
        for (std::size_t back = 0; back <= std::min<std::size_t>(2, t); ++back) {
            const char before = above[t - back];
            once = once == '1' || before == '1' ? '1' : once == '?' || before == '?' ? '?' : '0';
        }
        result.q.push_back(once);
    }
    return result;
}

/// Returns the first frames of another known label than the last known one.
std::vector<std::size_t> turns(const std::vector<char>& labels) {
    std::vector<std::size_t> found;
    char last = '?';
    for (std::size_t t = 0; t < labels.size(); ++t) {
        if (labels[t] == '?') continue;
        if (last != '?' && labels[t] != last) found.push_back(t);
        last = labels[t];
    }
    return found;
}

std::vector<std::vector<std::size_t>> expected(Variant variant, const Rehearsal& episode) {
    const std::size_t n = episode.rows.size();
    std::vector<bool> is_turn(n + 1);
    std::vector<bool> is_last(n);
    for (const auto* labels : {&episode.p, &episode.q, &episode.r}) {
        const auto found = turns(*labels);
        for (const std::size_t t : found) is_turn[t] = true;
        if (!found.empty()) is_last[found.back()] = true;
    }
    std::vector<std::vector<std::size_t>> all;
    if (variant == Variant::cut || variant == Variant::frozen)
        for (std::size_t turn = 0; turn < n; ++turn) {
            if (!is_last[turn]) continue;
            auto& order = all.emplace_back();
            for (std::size_t t = 0; t < n; ++t)
                if (t < turn || variant == Variant::frozen)
                    order.push_back(t < turn ? t : turn - 1);
        }
    if (variant == Variant::reversed && n > 1) {
        all.emplace_back();
        for (std::size_t t = n; t-- > 0;) all.back().push_back(t);
    }
    if (variant == Variant::phases_reversed &&
        std::find(is_turn.begin(), is_turn.end(), true) != is_turn.end()) {
        auto& order = all.emplace_back();
        std::size_t end = n;
        for (std::size_t begin = n; begin-- > 0;) {
            if (begin > 0 && !is_turn[begin]) continue;
            for (std::size_t t = begin; t < end; ++t) order.push_back(t);
            end = begin;
        }
    }
    return all;
}

TEST(Variants, HaveTheVerdictsOfFilesWithTheirFrames) {
    std::mt19937 random(37);
    std::vector<Rehearsal> recorded;
    std::vector<std::string> files;
    for (int e = 0; e < 80; ++e) {
        recorded.push_back(random_rehearsal(random));
        std::vector<std::size_t> all(recorded.back().rows.size());
        for (std::size_t t = 0; t < all.size(); ++t) all[t] = t;
        files.push_back(recorded.back().csv(all));
    }
    const std::vector<Variant> kinds = {Variant::reversed, Variant::cut, Variant::frozen,
                                        Variant::phases_reversed};
    const evaluate::Evaluation found = evaluated(kVaried, files, 2, kinds);
    const evaluate::Evaluation plain = evaluated(kVaried, files);
    ASSERT_EQ(found.variants.size(), kinds.size());
    std::vector<evaluate::Counts> sums(found.monitors.size());
    for (std::size_t v = 0; v < kinds.size(); ++v) {
        std::vector<std::string> variants;
        std::uint64_t too_short = 0;
        for (const Rehearsal& episode : recorded) {
            const auto orders = expected(kinds[v], episode);
            too_short += orders.empty() ? 1 : 0;
            for (const auto& order : orders) variants.push_back(episode.csv(order));
        }
        EXPECT_EQ(found.variants[v].made, variants.size());
        EXPECT_EQ(found.variants[v].left_out, too_short);
        EXPECT_GT(too_short, 0U);
        const evaluate::Evaluation of_files = evaluated(kVaried, variants, 2);
        for (std::size_t m = 0; m < sums.size(); ++m) {
            const evaluate::Counts& counts = of_files.monitors[m].episodes.counts;
            EXPECT_EQ(found.monitors[m].variants[v].counts, counts)
                << episodes::name_of(kinds[v]) << " of " << found.monitors[m].name;
            sums[m].add(counts);
        }
    }
    for (std::size_t m = 0; m < sums.size(); ++m) {
        EXPECT_EQ(found.monitors[m].variants.back().counts, sums[m]);
        EXPECT_EQ(found.monitors[m].episodes.counts, plain.monitors[m].episodes.counts);
        EXPECT_EQ(found.monitors[m].steps.counts, plain.monitors[m].steps.counts);
    }
    const auto json = [](const evaluate::Evaluation& evaluation) {
        return evaluate::json({{{"t.etl", evaluation, {}}}});
    };
    EXPECT_EQ(json(found), json(evaluated(kVaried, files, 1, kinds)));
}

TEST(Variants, AnEpisodeWithoutAChangeOfTruthIsOnlyReversed) {
    const std::string flat = "u,w,y,z[0],z[1],truth.p\n1,1,1,0,0,1\n2,1,1,1,1,1\n";
    const evaluate::Evaluation found =
        evaluated(kVaried, {flat}, 1,
                  {Variant::cut, Variant::phases_reversed, Variant::reversed, Variant::frozen});
    for (const evaluate::VariantsMade& kind : found.variants) {
        EXPECT_EQ(kind.made, kind.variant == Variant::reversed ? 1U : 0U);
        EXPECT_EQ(kind.left_out, kind.variant == Variant::reversed ? 0U : 1U);
    }
    EXPECT_NE(evaluate::table({{{"t.etl", found, {}}}})
                  .find("or without a change of a truth: 1 cut, 1 phases_reversed, 1 frozen\n"),
              std::string::npos);
}

}  // namespace
}  // namespace etlc::tests
