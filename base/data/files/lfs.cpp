#include "data/files/lfs.hpp"

#include <fstream>
#include <string_view>

namespace etlc::data {

bool is_lfs_pointer(const std::string& path) {
    constexpr std::string_view kBegin = "version https://git-lfs";
    std::string begin(kBegin.size(), '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    return file && begin == kBegin;
}

}  // namespace etlc::data
