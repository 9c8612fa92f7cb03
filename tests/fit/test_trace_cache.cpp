// Keeping episodes in memory affects only time: with all, none, or some of them kept, their samples
// are those of the files, and `etlc fit` gives the same bytes.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "checking.hpp"
#include "fit/fit.hpp"

namespace etlc::fit {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kEpisodes = 7;
constexpr std::size_t kSteps = 90;

const char* const kSpec = R"(
spec t;
input z : f32[3];
input x : f32;
input seen : bool;
projection L = fitted(discriminant, r = 1, of = z, where = p);
target anchors = fitted(medoids, k = 3, away = 1, of = z, where = p && q);
predicate p = min l2(L(z), anchors) <= calibrated(f1);
predicate q = x <= 5;
predicate both = min l2(z, anchors) + x <= 5;
truth p = x > 0 && (H[0,2] seen || x > 1);
truth both = x > -1;
monitor m = F (p && q && both);
)";

/// Drifting points with some missing samples.
class Episodes {
public:
    Episodes() : folder_(fs::temp_directory_path() / fmt::format("trace_cache.{}", ::getpid())) {
        fs::create_directories(folder_);
        std::mt19937 random(5);
        const auto number = [&] { return static_cast<double>(random() % 2000) / 1000 - 1; };
        for (std::size_t e = 0; e < kEpisodes; ++e) {
            request.episodes.push_back((folder_ / fmt::format("{}.csv", e)).string());
            std::ofstream file(request.episodes.back());
            file << "z[0],z[1],z[2],x,seen\n";
            double x = 0;
            for (std::size_t t = 0; t < kSteps + e; ++t) {
                x += number();
                const bool gone = random() % 20 == 0;
                file << (gone ? std::string(",,")
                              : fmt::format("{},{},{}", x + number(), number(), number() - x))
                     << ',' << (random() % 20 == 0 ? "" : fmt::format("{}", x)) << ','
                     << random() % 2 << '\n';
            }
        }
    }
    Episodes(const Episodes&) = delete;
    Episodes& operator=(const Episodes&) = delete;
    ~Episodes() { fs::remove_all(folder_); }

    Request request;

private:
    fs::path folder_;
};

/// Returns the file and the report.
std::string fitted(const check::Model& model, const Request& request) {
    diag::Sink sink;
    const auto result = fit(model, request, sink);
    if (!result) return "";
    return fitted::write(result->file) + result->report;
}

TEST(Recordings, AreTheSameFromMemoryAndFromFiles) {
    check::Options options;
    options.allow_unfitted = true;
    options.allow_uncalibrated = true;
    const Checked spec(kSpec, options);
    ASSERT_TRUE(spec.model) << spec.diagnostics();
    Episodes episodes;
    const std::string all_kept = fitted(*spec.model, episodes.request);
    ASSERT_NE(all_kept.find("both"), std::string::npos) << all_kept;
    for (const std::size_t bytes : {std::size_t{0}, std::size_t{6000}, std::size_t{20000}}) {
        episodes.request.cache_bytes = bytes;
        for (const unsigned jobs : {1U, 3U}) {
            episodes.request.jobs = jobs;
            EXPECT_EQ(fitted(*spec.model, episodes.request), all_kept) << bytes << " bytes";
        }
    }
}

/// A let in `where` stands for its truth, even where another selection has the same formula.
TEST(Fitted, FramesAreSelectedByTheTruthOfALet) {
    check::Options options;
    options.allow_unfitted = true;
    const Checked spec(
        "spec t; input z : f32[2]; input was : bool; target g = [[0, 0]];predicate p = l2(z, g) <= "
        "1;"
        "let late = !p && O p; truth late = was;"
        "target a = fitted(mean, of = z, where = late);"
        "target b = fitted(mean, of = z, where = !p && O p);"
        "target c = fitted(mean, of = z, where = !p && O p);"
        "monitor m = F late;",
        options);
    ASSERT_TRUE(spec.model) << spec.diagnostics();
    const check::Model& model = *spec.model;
    EXPECT_EQ(check::print(model, model.fitted[0].where), "was");
    EXPECT_EQ(check::print(model, model.fitted[1].where), "!p && O p");
    EXPECT_EQ(model.fitted[1].where, model.fitted[2].where);
    EXPECT_EQ(check::print(model, model.monitors[0].truth), "F was");
}

using Channels = std::vector<data::Channel>;

const data::Channel kZ{"z", data::Channel::Kind::vector, 3};
const data::Channel kX{"x", data::Channel::Kind::scalar};
const data::Channel kSeen{"seen", data::Channel::Kind::boolean};
const data::Channel kAbsent{"absent", data::Channel::Kind::scalar, 1, true};

/// Returns all samples of an episode, exactly, or what is wrong.
std::string samples(data::Trace& trace, std::size_t channels) {
    std::string text;
    for (std::size_t c = 0; c < channels; ++c) text += trace.has(c) ? "has " : "lacks ";
    for (data::Sample sample;;) {
        const auto more = trace.next(sample);
        if (!more) return more.failure().message;
        if (!*more) return text;
        for (std::size_t c = 0; c < channels; ++c)
            text += sample.present[c] ? fmt::format("{} ", fmt::join(sample.values[c], ",")) : "- ";
    }
}

struct Opened {
    std::string samples;
    bool was_kept = false;
};

Opened opened(episodes::TraceCache& cache, const std::string& path, const Channels& channels) {
    const auto found = cache.open(path, channels);
    if (!found) return {found.failure().message};
    const bool was_kept = found->trace->length() > 0;  // a CSV file does not give it
    return {samples(*found->trace, channels.size()), was_kept};
}

std::string in_file(const std::string& path, const Channels& channels) {
    const auto trace = recordings::open_trace(path, channels);
    return trace ? samples(**trace, channels.size()) : trace.failure().message;
}

TEST(TraceCache, HasTheSamplesOfItsFiles) {
    const Episodes all;
    data::Channel required = kAbsent;
    required.optional = false;
    for (const std::size_t bytes : {std::size_t{0}, std::size_t{3000}, episodes::kCacheBytes}) {
        episodes::TraceCache cache(bytes);
        for (const std::string& path : all.request.episodes)
            for (const Channels& channels :
                 {Channels{kZ}, {kZ, kX}, {kSeen, kAbsent, kX}, {kZ, required}, {kX, kZ, kAbsent}})
                EXPECT_EQ(opened(cache, path, channels).samples, in_file(path, channels));
        const bool keeps = bytes > 0;
        EXPECT_EQ(opened(cache, all.request.episodes[0], {kZ}).was_kept, keeps) << bytes;
        EXPECT_EQ(opened(cache, all.request.episodes[6], {kX, kZ, kSeen}).was_kept,
                  bytes == episodes::kCacheBytes);
        EXPECT_FALSE(opened(cache, all.request.episodes[0], {kZ, required}).was_kept);
    }
}

TEST(TraceCache, ReadsChangedFilesAgain) {
    const Episodes all;
    const std::string& path = all.request.episodes[0];
    episodes::TraceCache cache;
    const std::string before = opened(cache, path, {kX}).samples;
    ASSERT_TRUE(opened(cache, path, {kX}).was_kept);
    std::ofstream(path) << "z[0],z[1],z[2],x,seen\n1,2,3,0.1,1\n";
    for (const bool was_kept : {false, true}) {
        const Opened now = opened(cache, path, {kX});
        EXPECT_EQ(now.samples, "has 0.1 ");
        EXPECT_EQ(now.was_kept, was_kept);
    }
    EXPECT_EQ(opened(cache, path, {kX, kZ}).samples, "has has 0.1 1,2,3 ");
    std::ofstream(path) << "z[0],z[1],z[2],x,seen\n1,2,3,oops,1\n";
    EXPECT_EQ(opened(cache, path, {kX}).samples, in_file(path, {kX}));
    EXPECT_FALSE(opened(cache, path, {kX}).was_kept) << "an episode with an error";
    fs::remove(path);
    EXPECT_EQ(opened(cache, path, {kX}).samples, in_file(path, {kX}));
}

/// Only what was read to its end is kept, and its room is free again if it was not.
TEST(TraceCache, KeepsWholeEpisodes) {
    const Episodes all;
    const std::string& path = all.request.episodes[0];
    episodes::TraceCache cache(kSteps * (sizeof(double) + 1));  // room for one `x`
    for (int time = 0; time < 3; ++time) {
        const auto half = cache.open(path, {kX});
        data::Sample sample;
        for (std::size_t step = 0; step < kSteps / 2; ++step) half->trace->next(sample);
    }
    EXPECT_FALSE(opened(cache, path, {kX}).was_kept);
    EXPECT_TRUE(opened(cache, path, {kX}).was_kept);
    EXPECT_FALSE(opened(cache, all.request.episodes[1], {kX}).was_kept);
    EXPECT_FALSE(opened(cache, all.request.episodes[1], {kX}).was_kept) << "there is no room";
}

TEST(FreeBytes, AreNeverOverdrawn) {
    episodes::FreeBytes room(100);
    EXPECT_FALSE(room.take(11, 10));
    EXPECT_FALSE(room.take(UINT64_MAX, 10)) << "more than there are bytes to count";
    EXPECT_TRUE(room.take(9, 10));
    EXPECT_FALSE(room.take(2, 10));
    room.give_back(10);
    EXPECT_TRUE(room.take(2, 10));
    EXPECT_FALSE(room.take(1, 1));
}

}  // namespace
}  // namespace etlc::fit
