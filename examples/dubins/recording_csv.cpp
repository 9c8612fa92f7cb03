#include "recording_csv.hpp"

#include <fmt/core.h>

#include <fstream>
#include <stdexcept>

namespace demo {

void write_csv(const std::string& path, const Recording& recording) {
    std::ofstream file(path);
    file << "px,py";
    for (int i = 0; i < kDimension; ++i) file << ",z[" << i << "]";
    file << '\n';
    for (std::size_t i = 0; i < recording.steps.size(); ++i) {
        const Point position = recording.episode.states[i].position;
        file << fmt::format("{:.9g},{:.9g}", position.x, position.y);
        for (const float value : recording.steps[i].embedding) file << fmt::format(",{:.9g}", value);
        file << '\n';
    }
    file.close();
    if (!file) throw std::runtime_error(path + ": cannot be written");
}

}  // namespace demo
