// Runs a fuzz target on files, for compilers without libFuzzer.
// Takes: the name of a target, files and folders. Gives: exit status 0 if every file passed the
// target. A finding stops the program, and so does an input that takes more than kMostSeconds of
// processor time.
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "fuzz_target.hpp"

#define FUZZER(name) extern "C" int name(const std::uint8_t* data, std::size_t size);
#include "fuzzers.inc"
#undef FUZZER

namespace {

struct Target {
    const char* name;
    int (*run)(const std::uint8_t* data, std::size_t size);
};
constexpr Target kTargets[] = {
#define FUZZER(name) {#name, name},
#include "fuzzers.inc"
#undef FUZZER
};

#if defined(__SANITIZE_ADDRESS__) || defined(_GLIBCXX_DEBUG)
constexpr rlim_t kMostSeconds = 60;
#else
constexpr rlim_t kMostSeconds = 15;
#endif

/// Limits the time from here on; the signal SIGXCPU ends the program.
void limit_time() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    rlimit limit{};
    getrlimit(RLIMIT_CPU, &limit);
    limit.rlim_cur =
        static_cast<rlim_t>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) + 1 + kMostSeconds;
    setrlimit(RLIMIT_CPU, &limit);
}

}  // namespace

int main(int argc, char** argv) {
    namespace fs = std::filesystem;
    const std::string name = argc > 1 ? argv[1] : "";
    const auto target = std::find_if(std::begin(kTargets), std::end(kTargets),
                                     [&](const Target& one) { return one.name == name; });
    if (target == std::end(kTargets)) {
        std::printf("no target '%s'\n", name.c_str());
        return 2;
    }
    std::vector<fs::path> files;
    for (int i = 2; i < argc; ++i) {
        if (fs::is_directory(argv[i]))
            std::copy(fs::directory_iterator(argv[i]), {}, std::back_inserter(files));
        else
            files.emplace_back(argv[i]);
    }
    std::sort(files.begin(), files.end());
    for (const fs::path& path : files) {
        std::printf("%s\n", path.filename().c_str());
        std::fflush(stdout);  // so that the last line names the finding
        std::ifstream file(path, std::ios::binary);
        if (!file) {
            std::printf("cannot be read\n");
            return 1;
        }
        const std::string bytes((std::istreambuf_iterator<char>(file)), {});
        limit_time();
        target->run(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    }
    std::printf("%zu files\n", files.size());
    return files.empty() ? 1 : 0;
}
