// One spec compiled twice, with its target sets in the header and in a file: both give the same
// bits, on embeddings that walk, jump, stand still, touch rows, leave the range of float32, or are
// missing. Usage: main STORED.targets.bin
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "etlmon/hosted/mapped_targets.hpp"
#include "run.hpp"
#include "stored.hpp"

namespace {

using trial::Sample;

void say(bool right, const char* what) {
    if (right) return;
    std::printf("FAILED: %s\n", what);
    std::exit(1);
}

/// Embeddings of one dimension that could break a search over targets.
std::vector<Sample> trace(std::uint32_t width, unsigned seed, const std::vector<float>& rows) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    std::vector<Sample> steps;
    std::vector<float> z(width);
    const std::size_t count = rows.size() / width;
    for (int step = 0; step < trial::kSteps; ++step) {
        const auto kind = static_cast<unsigned>(random() % 40);
        const float* row = rows.data() + random() % count * width;
        if (kind == 0 || step == 0) z.assign(row, row + width);  // a row itself
        if (kind == 1)
            for (float& x : z) x = normal(random);  // a jump
        if (kind == 2)
            for (float& x : z) x *= 1e-25F;  // squares underflow
        if (kind == 3)
            for (float& x : z) x = 1e38F * normal(random);  // sums overflow
        if (kind == 4)
            for (float& x : z) x = 0;
        if (kind == 5)
            for (std::uint32_t i = 0; i < width; ++i)
                z[i] = 0.5F * (row[i] + rows[i]);  // between two rows
        if (kind == 6)
            for (std::uint32_t i = 0; i < width; ++i) z[i] = row[i] * (1 + 1e-6F * normal(random));
        if (kind > 12)
            for (float& x : z) x += (kind < 30 ? 0.002F : 0.05F) * normal(random);  // a walk
        if (kind > 1 && step > 0 && kind != 2 && (z[0] < -1e30F || z[0] > 1e30F) && kind != 3)
            z.assign(row, row + width);
        steps.push_back({random() % 20 != 0, z});
        if (random() % 30 == 0) steps.back().z[random() % width] = etlmon::kMissing;
    }
    return steps;
}

/// Reads the rows of a .npy file written by arrays.cpp.
std::vector<float> rows_of(const char* path) {
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    const std::size_t begin = bytes.find('\n') + 1;
    std::vector<float> rows((bytes.size() - begin) / sizeof(float));
    std::memcpy(rows.data(), bytes.data() + begin, rows.size() * sizeof(float));
    return rows;
}

/// A monitor without its targets has unknown verdicts for them.
void expect_unknown(stored::Monitor&& monitor, const char* what) {
    say(!monitor.ready(), what);
    const std::vector<float> ones(384, 1.0F);
    stored::Inputs in;
    in.wide = decltype(in.wide)::unchecked(ones.data());
    in.middle = decltype(in.middle)::unchecked(ones.data());
    in.narrow = decltype(in.narrow)::unchecked(ones.data());
    in.x = in.y = 0;
    const auto v = monitor.step(in);
#define MONITOR(name) say((v.name.unknown() || !v.name.decided()) && !v.name.final(), what);
#define PREDICATE(name) say(etlmon::is_nan(monitor.distance_##name()), what);
#define CONTRAST(name, near, far) PREDICATE(name)
#include "names.inc"
    say(monitor.missing_steps() == 1, what);
}

}  // namespace

int main(int, char** argv) {
    const etlmon::MappedTargets<stored::Targets> file(argv[1]);
    std::printf("%s: %s\n", argv[1], file.message());
    say(file.ready(), "the file that etlc wrote is ready");
    const auto size = static_cast<std::size_t>(stored::Targets::kSize);
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(file.targets().rows());
    say(stored::Monitor::valid(bytes, size), "its bytes are valid");

    const std::vector<float> wide = rows_of("wide.npy"), narrow = rows_of("narrow.npy");
    std::vector<float> middle = rows_of("middle.npy");  // measured from two sets
    for (const float x : rows_of("others.npy")) middle.push_back(x);
    for (unsigned seed = 1; seed <= SEEDS; ++seed) {
        const auto a = trace(384, seed, wide), b = trace(33, seed + 100, middle),
                   c = trace(7, seed + 200, narrow);
        auto two = std::make_unique<stored::Monitor>(file.targets());
        auto three = std::make_unique<stored::Monitor>(bytes, size);
        const auto expected = run_inlined(a, b, c);
        const auto found = trial::run<stored::Inputs>(*two, a, b, c);
        for (std::size_t i = 0; i < expected.size(); ++i) {
            if (expected[i] == found[i]) continue;
            const std::size_t a_step = expected.size() / trial::kSteps;
            std::printf("FAILED: seed %u, step %zu, word %zu: %08x, in the file %08x\n", seed,
                        i / a_step, i % a_step, expected[i], found[i]);
            return 1;
        }
        say(trial::run<stored::Inputs>(*three, a, b, c) == expected, "the same from a pointer");
    }
    expect_unknown(stored::Monitor(stored::Targets()), "no targets");
    expect_unknown(stored::Monitor(nullptr, size), "null");
    expect_unknown(stored::Monitor(bytes, size - 64), "truncated");
    say(!etlmon::MappedTargets<stored::Targets>("absent.bin").ready(), "no such file");
    std::puts("equal");
}
