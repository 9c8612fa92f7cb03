// SPDX-License-Identifier: MIT
// Maps a file of targets into memory, for programs on a POSIX host; generated code does not include
// this. Takes: a path. Gives: its Targets, for the constructor of a monitor, or the reason for
// their absence. Keeps true: the file stays mapped for the lifetime of this object; targets() are
// ready only if size and checksum are right; nothing is thrown. Shortening a mapped file kills its
// readers (SIGBUS): replace it by renaming another file to its name, as etlc does.
#pragma once

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "etlmon/distance/targets.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// `Targets`: the type in the generated header.
template <class Targets>
class MappedTargets {
 public:
  explicit MappedTargets(const char* etlmon_path) noexcept {
    // open() of a pipe would wait for a writer.
    const int file = ::open(etlmon_path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file < 0) {
      error_ = errno;
      return;
    }
    struct stat status;
    if (::fstat(file, &status) != 0)
      error_ = errno;
    else if (S_ISDIR(status.st_mode))
      error_ = EISDIR;
    else if (static_cast<uint64_t>(status.st_size) != Targets::kSize)
      state_ = TargetsState::wrong_size;
    else
      map(file);
    static_cast<void>(::close(file));
  }
  ~MappedTargets() {
    if (bytes_ != nullptr) static_cast<void>(::munmap(bytes_, kBytes));
  }
  MappedTargets(const MappedTargets&) = delete;
  MappedTargets& operator=(const MappedTargets&) = delete;

  bool ready() const noexcept { return targets_.ready(); }
  const Targets& targets() const noexcept { return targets_; }
  /// Returns why they are not ready; `absent` if the file could not be read, for the reason in
  /// error().
  TargetsState state() const noexcept { return state_; }
  int error() const noexcept { return error_; }  ///< an errno, or 0
  const char* message() const noexcept { return error_ != 0 ? ::strerror(error_) : words(state_); }

 private:
  static constexpr size_t kBytes = static_cast<size_t>(Targets::kSize);
  static_assert(kBytes == Targets::kSize && kBytes > 0, "the file can be addressed");

  void map(int file) noexcept {
    void* const bytes = ::mmap(nullptr, kBytes, PROT_READ, MAP_PRIVATE, file, 0);
    if (bytes == MAP_FAILED) {
      error_ = errno;
      return;
    }
    bytes_ = bytes;
    targets_ = Targets(static_cast<const uint8_t*>(bytes), kBytes);
    state_ = targets_.state();
  }

  Targets targets_;
  void* bytes_ = nullptr;
  TargetsState state_ = TargetsState::absent;
  int error_ = 0;
};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
