// Git LFS: what a clone holds in place of a large file until `git lfs pull`.
#pragma once

#include <string>

namespace etlc::data {

bool is_lfs_pointer(const std::string& path);

inline constexpr const char* kIsLfsPointer =
    "is a pointer of Git LFS in place of the file; `git lfs pull` fetches it";

}  // namespace etlc::data
