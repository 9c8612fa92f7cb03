// Compares many episodes without holding all of them: the suspects find everything that all of them
// would, and data in files come back.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "data/files/hash.hpp"
#include "data/traces/overlap.hpp"

namespace etlc::data {
namespace {

/// Draws contents like those of recordings, but small; many have something in common.
class Drawn {
public:
    /// `common`: units that all episodes have in every input.
    Drawn(unsigned seed, std::size_t common) : random_(seed) {
        for (std::size_t i = 0; i < common; ++i) common_.push_back(unit());
    }

    EpisodeContent episode() {
        if (!made_.empty() && draw(8) == 0) return made_[draw(made_.size())];
        EpisodeContent result;
        for (const char* name : {"image", "pose", "x"})
            if (draw(4) > 0) result[name] = input(name);
        made_.push_back(result);
        return result;
    }

private:
    std::size_t draw(std::size_t below) { return random_() % below; }
    std::uint32_t unit() { return static_cast<std::uint32_t>(random_()); }

    /// Some units of another episode, and some new ones.
    InputContent input(const std::string& name) {
        if (!made_.empty() && draw(8) == 0) {
            const EpisodeContent& other = made_[draw(made_.size())];
            if (const auto same = other.find(name); same != other.end()) return same->second;
        }
        Sketch units = common_;
        if (!made_.empty() && draw(2) == 0) {
            const EpisodeContent& other = made_[draw(made_.size())];
            if (const auto same = other.find(name); same != other.end()) {
                units = same->second.sketch;
                std::shuffle(units.begin(), units.end(), random_);
                units.resize(std::min(units.size(), draw(14)));
            }
        }
        for (std::size_t own = draw(draw(8) == 0 ? 150 : 10); own > 0; --own)
            units.push_back(unit());
        std::sort(units.begin(), units.end());
        units.erase(std::unique(units.begin(), units.end()), units.end());
        InputContent result{hash_text(random_()), units};
        if (name == "x") return result;
        result.samples = draw(4) == 0 ? Samples::recurring : Samples::apart;
        if (result.samples == Samples::recurring) result.changes = units;
        return result;
    }

    std::mt19937_64 random_;
    Sketch common_;
    std::vector<EpisodeContent> made_;
};

using Answer = std::optional<Overlap>;

std::string text(const Answer& answer) {
    if (!answer) return "none";
    return std::to_string(answer->other) + (answer->equal ? " equal " : " in part ") +
           std::to_string(answer->share);
}

/// Holds only the suspects, under their numbers among all.
class OfSuspects {
public:
    explicit OfSuspects(const std::vector<bool>& is_suspect) : is_suspect_(is_suspect) {}

    void add(std::size_t number, const EpisodeContent& content) {
        if (!is_suspect_[number]) return;
        recordings_.add(content);
        numbers_.push_back(number);
    }
    Answer find(std::size_t number, const EpisodeContent& content) const {
        Answer found = is_suspect_[number] ? recordings_.find(content) : std::nullopt;
        if (found) found->other = numbers_[found->other];
        return found;
    }

private:
    const std::vector<bool>& is_suspect_;
    Recordings recordings_;
    std::vector<std::size_t> numbers_;
};

struct Tally {
    std::size_t suspects = 0;
    std::size_t equal = 0;
    std::size_t in_part = 0;

    void add(const Answer& answer) {
        equal += answer && answer->equal ? 1 : 0;
        in_part += answer && !answer->equal ? 1 : 0;
    }
};

/// Compares each of `n` episodes with those before it.
void compare_with_earlier(Drawn drawn, std::size_t n, Tally& tally) {
    std::vector<EpisodeContent> episodes(n);
    Suspects suspects(true);
    for (EpisodeContent& episode : episodes) {
        episode = drawn.episode();
        suspects.ask(episode);
    }
    const std::vector<bool> is_suspect = suspects.find();
    Recordings all;
    OfSuspects some(is_suspect);
    for (std::size_t e = 0; e < n; ++e) {
        const Answer expected = all.find(episodes[e]);
        ASSERT_EQ(text(some.find(e, episodes[e])), text(expected)) << e;
        all.add(episodes[e]);
        some.add(e, episodes[e]);
        tally.add(expected);
        tally.suspects += is_suspect[e] ? 1 : 0;
    }
}

/// Compares each of some episodes with others.
void compare_with_known(Drawn drawn, std::size_t n, Tally& tally) {
    std::vector<EpisodeContent> episodes(n);
    Suspects suspects(false);
    for (std::size_t e = 0; e < n; ++e) {
        episodes[e] = drawn.episode();
        e < n / 2 ? suspects.ask(episodes[e]) : suspects.know(episodes[e]);
    }
    const std::vector<bool> is_suspect = suspects.find();
    Recordings all;
    OfSuspects some(is_suspect);
    for (std::size_t e = n / 2; e < n; ++e) {
        all.add(episodes[e]);
        some.add(e, episodes[e]);
        tally.suspects += is_suspect[e] ? 1 : 0;
    }
    for (std::size_t e = 0; e < n / 2; ++e) {
        Answer expected = all.find(episodes[e]);
        if (expected) expected->other += n / 2;
        ASSERT_EQ(text(some.find(e, episodes[e])), text(expected)) << e;
        tally.add(expected);
    }
}

constexpr unsigned kWorlds = 300;
constexpr std::size_t kEpisodes = 24;

TEST(Suspects, FindWhatAllEpisodesFind) {
    Tally tally;
    for (unsigned seed = 0; seed < kWorlds; ++seed) {
        compare_with_earlier(Drawn(seed, 0), kEpisodes, tally);
        compare_with_known(Drawn(seed, 0), kEpisodes, tally);
    }
    EXPECT_GT(tally.equal, 100U);
    EXPECT_GT(tally.in_part, 100U);
    EXPECT_LT(tally.suspects, kWorlds * kEpisodes * 5 / 4);  // 1.5 times as many
}

TEST(Suspects, FindTheSameWhereAllEpisodesShareUnits) {
    Tally tally;
    for (unsigned seed = 0; seed < kWorlds; ++seed) {
        const std::size_t common = seed % 12;  // fewer, and more, than needed
        compare_with_earlier(Drawn(seed, common), kEpisodes, tally);
        compare_with_known(Drawn(seed, common), kEpisodes, tally);
    }
    EXPECT_GT(tally.equal, 100U);
    EXPECT_GT(tally.in_part, 1000U);
}

TEST(Suspects, AreFewAmongDifferentRecordings) {
    Suspects suspects(true);
    std::mt19937_64 random(1);
    constexpr std::size_t kMany = 3000;  // whose units exceed the memory limit
    for (std::size_t e = 0; e < kMany; ++e) {
        Sketch units{1};                       // that all have
        for (std::size_t i = 0; i < 100; ++i)  // each shares some with others
            units.push_back(3 + static_cast<std::uint32_t>(random() % 600'000));
        std::sort(units.begin(), units.end());
        units.erase(std::unique(units.begin(), units.end()), units.end());
        suspects.ask({{"z", {hash_text(e == 1234 ? 99 : e), units}}});
    }
    const std::vector<bool> found = suspects.find();
    EXPECT_TRUE(found[99]);
    EXPECT_TRUE(found[1234]);
    EXPECT_EQ(std::count(found.begin(), found.end(), true), 2);
}

TEST(Suspects, OfThoseThatAreNotComparedThereAreNone) {
    const EpisodeContent one{{"z", {"0123456789abcdef", {1, 2, 3, 4, 5, 6, 7, 8}}}};
    Suspects suspects(false);
    suspects.ask(one);
    suspects.ask(one);
    EXPECT_EQ(suspects.find(), (std::vector<bool>{false, false}));
    suspects.know({{"w", one.at("z")}});  // in another input
    EXPECT_EQ(suspects.find(), (std::vector<bool>{false, false, false}));
    suspects.know(one);
    EXPECT_EQ(suspects.find(), (std::vector<bool>{true, true, false, true}));
}

EpisodeContent content(std::uint32_t number) {
    return {{"z", {hash_text(number), Sketch(200, number)}}};
}

std::map<std::uint64_t, std::uint32_t> all_of(const KnownEpisodes& known) {
    std::map<std::uint64_t, std::uint32_t> result;
    known.for_each([&](std::uint64_t hash, const EpisodeContent& found) {
        EXPECT_TRUE(result.empty() || result.rbegin()->first < hash);
        result[hash] = found.at("z").sketch.at(0);
    });
    return result;
}

TEST(KnownEpisodes, StandInTheOrderOfTheirHashesAndTheLastOfEachCounts) {
    KnownEpisodes known;
    EXPECT_TRUE(known.empty());
    std::map<std::uint64_t, std::uint32_t> expected;
    std::mt19937_64 random(1);
    for (std::uint32_t i = 0; i < 20'000; ++i) {  // more than stay in memory
        const std::uint64_t hash = random() % 15'000 << 48U;
        known.add(hash, content(i));
        expected[hash] = i;
    }
    EXPECT_FALSE(known.empty());
    EXPECT_EQ(all_of(known), expected);
    EXPECT_EQ(all_of(known), expected);  // and once more
    known.add(7, content(1));
    expected[7] = 1;
    EXPECT_EQ(all_of(known), expected);
}

TEST(KnownEpisodes, CopiesChangeAlone) {
    KnownEpisodes first;
    first.add(1, content(1));
    KnownEpisodes second = first;
    second.add(2, content(2));
    first.add(1, content(3));
    EXPECT_EQ(all_of(first), (std::map<std::uint64_t, std::uint32_t>{{1, 3}}));
    EXPECT_EQ(all_of(second), (std::map<std::uint64_t, std::uint32_t>{{1, 1}, {2, 2}}));
    KnownEpisodes third = second;
    third.keep({2, 5});
    EXPECT_EQ(all_of(third), (std::map<std::uint64_t, std::uint32_t>{{2, 2}}));
    EXPECT_EQ(all_of(second).size(), 2U);
    third.keep({});
    EXPECT_TRUE(third.empty());
}

}  // namespace
}  // namespace etlc::data
