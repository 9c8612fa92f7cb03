#include "record_files.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <stdexcept>

#include "data/arrays/archive.hpp"

namespace demo {

namespace {

void write_file(const std::string& path, const std::string& bytes) {
    std::ofstream file(path, std::ios::binary);
    file << bytes;
    file.close();
    if (!file) throw std::runtime_error(path + ": cannot be written");
}

}  // namespace

void write_csv(const std::string& path, const std::vector<Car>& states,
               const std::vector<Embedding>& embeddings) {
    std::string text = "px,py";
    for (int i = 0; i < kDimension; ++i) text += fmt::format(",z[{}]", i);
    text += '\n';
    const auto out = std::back_inserter(text);
    for (std::size_t i = 0; i < states.size(); ++i) {
        fmt::format_to(out, "{:.9g},{:.9g}", states[i].position.x, states[i].position.y);
        for (const float value : embeddings[i]) fmt::format_to(out, ",{:.9g}", value);
        text += '\n';
    }
    write_file(path, text);
}

void write_npz(const std::string& path, const std::vector<Car>& states,
               const std::vector<Embedding>& embeddings) {
    std::vector<float> px, py, z;
    std::vector<std::uint8_t> camera;
    for (std::size_t i = 0; i < states.size(); ++i) {
        px.push_back(static_cast<float>(states[i].position.x));
        py.push_back(static_cast<float>(states[i].position.y));
        z.insert(z.end(), embeddings[i].begin(), embeddings[i].end());
        const Image image = photograph(states[i]);
        camera.insert(camera.end(), image.begin(), image.end());
    }
    using etlc::data::npy_bytes;
    using etlc::data::npy_of_uint8;
    const std::uint64_t steps = states.size();
    write_file(path, etlc::data::npz_bytes({
                         {"px.npy", npy_bytes({steps}, px)},
                         {"py.npy", npy_bytes({steps}, py)},
                         {"z.npy", npy_bytes({steps, kDimension}, z)},
                         {"camera.npy", npy_of_uint8({steps, kImageSide, kImageSide}, camera)},
                     }));
}

}  // namespace demo
