#include "incident_files.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace patrol_node {

void IncidentFiles::write(patrol::Monitor& monitor) {
    while (done_ < monitor.incidents() && write(monitor, done_)) ++done_;
    lost_ = lost_before_ + monitor.lost_incidents();
    // The recorder is full, and all its incidents are in files and complete.
    if (done_ < kMostIncidents) return;
    lost_before_ = lost_;
    monitor.forget_incidents();
    done_ = 0;
}

bool IncidentFiles::write(const patrol::Monitor& monitor, std::uint32_t incident) {
    std::string path;
    do {
        path = folder_ + "/patrol-incident-" + std::to_string(number_);
    } while (std::filesystem::exists(path) && ++number_ != 0);
    const std::string part = path + ".part";
    std::FILE* const file = std::fopen(part.c_str(), "wb");
    bool good = file != nullptr;
    if (good) {
        monitor.write_incident(incident, [&](const std::uint8_t* bytes, std::size_t size) {
            good = good && std::fwrite(bytes, 1, size, file) == size;
        });
        good = std::fclose(file) == 0 && good;
    }
    good = good && std::rename(part.c_str(), path.c_str()) == 0;
    if (!good) {
        mistake_ = path + ": " + std::strerror(errno);
        if (file != nullptr) std::remove(part.c_str());
        return false;
    }
    mistake_.clear();
    last_ = path;
    ++number_;
    ++written_;
    return true;
}

}  // namespace patrol_node
