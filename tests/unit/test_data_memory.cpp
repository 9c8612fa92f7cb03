// Memory does not grow with the length of a trace, nor with the claims of a hostile header.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "data/arrays/array.hpp"
#include "data/traces/trace_formats.hpp"
#include "npy_bytes.hpp"

namespace etlc::data {
namespace {

using Kind = Channel::Kind;

constexpr std::uint64_t kMiB = 1ULL << 20U;

/// Returns the resident bytes of this process.
std::uint64_t resident_bytes() {
    std::ifstream file("/proc/self/statm");
    std::uint64_t pages = 0;
    std::uint64_t resident = 0;
    file >> pages >> resident;
    EXPECT_GT(resident, 0U);
    return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

/// Reads a trace to its end. Returns its steps and the growth of memory, in bytes.
std::pair<std::uint64_t, std::uint64_t> read_all(Trace& trace) {
    Sample sample;
    std::uint64_t steps = 0;
    std::uint64_t before = resident_bytes();
    std::uint64_t most = before;
    for (;;) {
        const auto more = trace.next(sample);
        EXPECT_TRUE(more);
        if (!more || !*more) break;
        if (steps == 100) before = most = resident_bytes();  // buffers are allocated by now
        if (++steps % 1000 == 0) most = std::max(most, resident_bytes());
    }
    return {steps, most - before};
}

/// A generated .csv file: a header, then `rows` rows of 100 bytes.
class EndlessCsv final : public ByteSource {
public:
    explicit EndlessCsv(std::uint64_t rows)
        : rows_(rows), row_(std::string(96, '1') + ",25\n"), rest_(kHeader) {}
    diag::Result<std::size_t> read(char* to, std::size_t n) override {
        std::size_t done = 0;
        while (done < n) {
            if (rest_.empty() && rows_ > 0) {
                rest_ = row_;
                --rows_;
            }
            if (rest_.empty()) break;
            const std::size_t part = std::min(n - done, rest_.size());
            std::copy_n(rest_.data(), part, to + done);
            rest_.remove_prefix(part);
            done += part;
        }
        return done;
    }
    std::uint64_t size() const override { return 0; }

private:
    static constexpr std::string_view kHeader = "note,g\n";
    std::uint64_t rows_;
    std::string row_;
    std::string_view rest_;
};

TEST(Memory, LongCsv) {
    constexpr std::uint64_t kRows = 600'000;  // 60 MB
    auto trace = open_csv_trace(std::make_unique<EndlessCsv>(kRows), {{"g", Kind::scalar, 1}});
    ASSERT_TRUE(trace);
    const auto [steps, grown] = read_all(**trace);
    EXPECT_EQ(steps, kRows);
    EXPECT_LT(grown, 16 * kMiB);  // sanitizers keep freed memory for a while
}

/// A deflated archive with one array `z` of 32 columns of float32, 48 MiB when unpacked.
std::string long_archive(bool fortran) {
    constexpr std::uint64_t kRows = 393'216;
    return tests::zip_of(
        {{"z.npy", tests::npy("<f4", "(393216, 32)", std::string(kRows * 32 * 4, '\0'), fortran)}});
}

TEST(Memory, LongNpz) {
    for (const bool fortran : {false, true}) {
        const std::string bytes = long_archive(fortran);
        EXPECT_LT(bytes.size(), kMiB);
        const tests::TemporaryPath file("run.npz", bytes);
        auto trace = open_npz_trace(file.path(), {{"z", Kind::vector, 32}});
        ASSERT_TRUE(trace) << trace.failure().message;
        const auto [steps, grown] = read_all(**trace);
        EXPECT_EQ(steps, 393'216U);
        EXPECT_LT(grown, 16 * kMiB) << fortran;  // a block is 8 MiB
    }
}

TEST(Memory, HeadersThatLie) {
    // Header and archive both declare 400 MB; 8 bytes are present.
    const std::string data = tests::floats({1, 2});
    const std::string lie = tests::npy("<f4", "(100000000,)", data);
    const std::string bytes =
        tests::patched(tests::zip_of({{"z.npy", lie, false}}), tests::little_endian(lie.size(), 4),
                       tests::little_endian(lie.size() - 8 + 400'000'000, 4));
    const std::uint64_t before = resident_bytes();
    EXPECT_FALSE(tests::parse_npz(bytes, "z"));
    EXPECT_FALSE(tests::parse_npy(lie));
    EXPECT_LT(resident_bytes() - std::min(before, resident_bytes()), 8 * kMiB);
}

}  // namespace
}  // namespace etlc::data
