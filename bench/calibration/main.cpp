// The costs of calibration and fitting beside reading: compares `etlc calibrate` over many
// episodes, and `etlc fit` over the first hundred, with libzip alone on the same files.
// bench_calibrate FOLDER [--episodes N] [--frames N] [--dimension N] [--rounds N]: makes missing
// episodes in the folder, then runs both in turns. Prints seconds, their ratio, the peak memory of
// etlc, and whether one thread gives the same bytes.
#include <sys/resource.h>
#include <sys/wait.h>
#include <zip.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Size {
    std::uint32_t episodes = 2000;
    std::uint32_t frames = 300;
    std::uint32_t dimension = 768;
};

/// Magic, version 1, length and dictionary, padded to 64 bytes, as numpy.save writes them.
std::string npy_header(const std::string& type, const std::string& shape) {
    std::string dictionary =
        "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }";
    dictionary.append(63 - (10 + dictionary.size()) % 64, ' ');
    dictionary += '\n';
    const auto length = static_cast<std::uint16_t>(dictionary.size());
    return std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(length & 0xff) +
           static_cast<char>(length >> 8) + dictionary;
}

std::string bytes_of(const std::vector<float>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)};
}

/// Stored, as by numpy.savez.
void write_npz(const fs::path& path,
               const std::vector<std::pair<std::string, std::string>>& members) {
    zip_t* archive = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, nullptr);
    if (archive == nullptr) throw std::runtime_error("cannot write " + path.string());
    for (const auto& [name, bytes] : members) {
        zip_source_t* source = zip_source_buffer(archive, bytes.data(), bytes.size(), 0);
        const zip_int64_t index = zip_file_add(archive, name.c_str(), source, 0);
        zip_set_file_compression(archive, static_cast<zip_uint64_t>(index), ZIP_CM_STORE, 0);
    }
    if (zip_close(archive) != 0) throw std::runtime_error("cannot write " + path.string());
}

/// Every episode has a stretch of frames near one of eight targets, labelled accordingly.
void make_episodes(const fs::path& folder, const Size& size) {
    std::mt19937 random(1);
    std::vector<float> noise(1U << 20U);  // drawn once, read from many places
    std::normal_distribution<float> normal;
    for (float& x : noise) x = normal(random);
    const auto drawn = [&] { return noise[random() % noise.size()]; };
    std::vector<float> targets(std::size_t{8} * size.dimension);
    std::generate(targets.begin(), targets.end(), drawn);
    std::ofstream(folder / "near.npy", std::ios::binary)
        << npy_header("<f4", "(8, " + std::to_string(size.dimension) + ")") << bytes_of(targets);
    std::ofstream(folder / "near.etl")
        << "spec near;\ninput z : f32[" << size.dimension
        << "];\ntarget goal = load(\"near.npy\");\n"
           "predicate near = min l2(z, goal) <= calibrated(conformal, alpha = 0.1);\n"
           "monitor m = F near;\n";
    const std::string frames = std::to_string(size.frames);
    fs::create_directories(folder / "episodes");
    for (std::uint32_t e = 0; e < size.episodes; ++e) {
        std::vector<float> z(std::size_t{size.frames} * size.dimension);
        std::string truth(size.frames, '\0');
        const std::size_t start = random() % noise.size();
        const float own = 1e-4F * static_cast<float>(e);  // no two episodes share a frame
        for (std::size_t i = 0; i < z.size(); ++i) z[i] = noise[(start + i) % noise.size()] + own;
        for (std::uint32_t f = size.frames / 3; f < size.frames / 2; ++f) {
            truth[f] = '\1';
            for (std::uint32_t d = 0; d < size.dimension; ++d)
                z[std::size_t{f} * size.dimension + d] =
                    targets[std::size_t{e % 8} * size.dimension + d] + 0.3F * drawn();
        }
        const std::string shape = "(" + frames + ", " + std::to_string(size.dimension) + ")";
        write_npz(folder / "episodes" / (std::to_string(e) + ".npz"),
                  {{"z.npy", npy_header("<f4", shape) + bytes_of(z)},
                   {"truth.near.npy", npy_header("|b1", "(" + frames + ",)") + truth}});
    }
}

std::uint64_t read_all(const fs::path& folder) {
    std::vector<char> buffer(1U << 16U);
    std::uint64_t total = 0;
    for (const auto& entry : fs::directory_iterator(folder)) {
        zip_t* archive = zip_open(entry.path().c_str(), ZIP_RDONLY, nullptr);
        if (archive == nullptr) throw std::runtime_error("cannot read " + entry.path().string());
        for (zip_int64_t i = 0; i < zip_get_num_entries(archive, 0); ++i) {
            zip_file_t* member = zip_fopen_index(archive, static_cast<zip_uint64_t>(i), 0);
            for (zip_int64_t got = 1; got > 0; total += static_cast<std::uint64_t>(got))
                got = std::max<zip_int64_t>(0, zip_fread(member, buffer.data(), buffer.size()));
            zip_fclose(member);
        }
        zip_close(archive);
    }
    return total;
}

void etlc(const fs::path& folder, const std::string& arguments) {
    const std::string command =
        "cd '" + folder.string() + "' && '" ETLC_COMMAND "' " + arguments + " > report.txt";
    if (std::system(command.c_str()) != 0) throw std::runtime_error(command + " failed");
}

void calibrate(const fs::path& folder, const std::string& options, const std::string& output) {
    etlc(folder, "calibrate near.etl --data episodes " + options + " -o " + output);
}

/// Sixteen components, and a discriminant.
void write_fitted_spec(const fs::path& folder, const Size& size) {
    std::ofstream(folder / "fitted.etl")
        << "spec fitted;\ninput z : f32[" << size.dimension
        << "];\n"
           "projection P = fitted(pca, r = 16, of = z, where = true);\n"
           "projection L = fitted(discriminant, r = 1, of = z, where = near);\n"
           "target goal = fitted(mean, of = P(z), where = near);\n"
           "target side = fitted(mean, of = L(z), where = near);\n"
           "predicate near = l2(P(z), goal) + l2(L(z), side) <= calibrated(f1);\n"
           "monitor m = F near;\n";
}

void fit(const fs::path& folder) {
    std::string first;  // episodes with numbers of up to two digits
    for (const char* pattern : {"?.npz", "??.npz"})
        first += std::string(" 'episodes/") + pattern + "'";
    etlc(folder, "fit fitted.etl --data" + first + " -o fitted.npz");
}

template <class Work>
double seconds(const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

std::string content(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

int main(int argc, char** argv) {
    fs::path folder;
    Size size;
    int rounds = 5;
    CLI::App app{"What calibration and fitting cost beside reading the same files through libzip."};
    app.add_option("folder", folder, "where the episodes are, or are made")->required();
    app.add_option("--episodes", size.episodes)->capture_default_str()->check(CLI::PositiveNumber);
    app.add_option("--frames", size.frames)->capture_default_str()->check(CLI::PositiveNumber);
    app.add_option("--dimension", size.dimension)
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    app.add_option("--rounds", rounds, "figures are medians over them")->check(CLI::PositiveNumber);
    CLI11_PARSE(app, argc, argv);

    fs::create_directories(folder);
    if (!fs::exists(folder / "episodes")) make_episodes(folder, size);
    std::uint64_t bytes = read_all(folder / "episodes");  // also into the page cache
    write_fitted_spec(folder, size);
    const double fitted = std::min(100.0 / size.episodes, 1.0);  // part of the episodes
    std::vector<double> reading, one, all, ratios, fits, fit_ratios;
    for (int round = 0; round < rounds; ++round) {
        reading.push_back(seconds([&] { bytes = read_all(folder / "episodes"); }));
        one.push_back(seconds([&] { calibrate(folder, "--jobs 1", "one.json"); }));
        all.push_back(seconds([&] { calibrate(folder, "", "all.json"); }));
        ratios.push_back(all.back() / reading.back());
        fits.push_back(seconds([&] { fit(folder); }));
        fit_ratios.push_back(fits.back() / (fitted * reading.back()));
    }
    rusage children{};
    getrusage(RUSAGE_CHILDREN, &children);
    std::printf(
        "%.2f GB; seconds: libzip %.2f, etlc calibrate %.2f (one thread %.2f); %.2f times libzip\n",
        static_cast<double>(bytes) * 1e-9, median(reading), median(all), median(one),
        median(ratios));
    std::printf("etlc fit on %.0f of the episodes %.2f s; %.1f times libzip on these\n",
                fitted * size.episodes, median(fits), median(fit_ratios));
    std::printf(
        "etlc took at most %ld MB; one thread and all gave %s bytes\n", children.ru_maxrss / 1024,
        content(folder / "one.json") == content(folder / "all.json") ? "the same" : "DIFFERENT");
    return 0;
}
