#include "recording_csv.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <stdexcept>

namespace demo {

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
    std::ofstream file(path, std::ios::binary);
    file << text;
    file.close();
    if (!file) throw std::runtime_error(path + ": cannot be written");
}

}  // namespace demo
