// Keeps what was read of episodes in memory, so that the stages of a call read each file once. A
// kept episode gives the samples of its file. Episodes beyond the limit, those with errors, and
// files that have changed meanwhile are read again; of a data set, only its folder is looked at.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "diag/diag.hpp"
#include "recordings/episodes.hpp"
#include "recordings/open.hpp"

namespace etlc::episodes {

/// The most bytes of samples that a call keeps, over all episodes.
inline constexpr std::size_t kCacheBytes = std::size_t{256} << 20U;

/// A thread-safe count of free bytes.
class FreeBytes {
public:
    explicit FreeBytes(std::size_t bytes) : left_(bytes) {}

    /// Takes `count` times `bytes`; returns false where fewer are free.
    bool take(std::uint64_t count, std::size_t bytes);
    void give_back(std::size_t bytes) { left_ += bytes; }

private:
    std::atomic<std::size_t> left_;
};

/// Distinguishes an episode from others by some of its inputs.
struct Identity {
    std::string hash;  ///< 16 hex digits
    data::EpisodeContent content;
};

/// The identities of an episode by the inputs that they are of, so that each is computed once.
/// Thread-safe.
class IdentityCache {
public:
    std::shared_ptr<const Identity> find(const std::string& inputs) const;
    void add(const std::string& inputs, std::shared_ptr<const Identity> identity);

private:
    mutable std::mutex changing_;
    std::map<std::string, std::shared_ptr<const Identity>> all_;
};

/// Thread-safe. It outlives the traces that it opens.
class TraceCache {
public:
    explicit TraceCache(std::size_t most = kCacheBytes) : free_(most) {}

    struct Opened {
        std::unique_ptr<data::Trace> trace;
        std::shared_ptr<IdentityCache> identities;  ///< of its frames; null: they are not kept
    };
    /// Opens an episode as recordings::open_trace does: from memory if these channels are kept,
    /// else from its file, and keeps them once it is read to its end.
    diag::Result<Opened> open(const std::string& path, const std::vector<data::Channel>& channels);

private:
    class Column;
    class Keeper;
    class Player;

    /// Place, size and times of a file.
    using Stamp = std::tuple<std::uint64_t, std::uint64_t, std::int64_t, std::int64_t, std::int64_t,
                             std::int64_t, std::int64_t>;
    /// Name, kind and width of a channel.
    using Key = std::tuple<std::string, data::Channel::Kind, std::uint32_t>;
    struct Episode {
        Stamp stamp{};
        std::uint64_t frames = 0;
        std::size_t bytes = 0;
        std::map<Key, std::shared_ptr<const Column>> columns;
        std::shared_ptr<IdentityCache> identities;
    };

    static std::optional<Stamp> stamp_of(const std::string& path);
    static Key key_of(const data::Channel& channel) {
        return {channel.name, channel.kind, channel.width};
    }
    /// Returns what is kept of a file with this stamp.
    Episode cached(const std::string& path, const Stamp& stamp) const;
    /// Keeps more of an episode, whose bytes were taken from the room.
    void keep(const std::string& path, Episode more);

    FreeBytes free_;
    mutable std::mutex changing_;
    std::map<std::string, Episode> episodes_;
};

}  // namespace etlc::episodes
