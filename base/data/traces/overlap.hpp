// What of an episode tells whether another is the same recording, or a part of it.
// Takes: the samples of each input, a step after the other. Gives: per input a hash of all of them,
// and a sketch: a sample of the hashes of what it holds, by which shares of equal content are
// estimated. Keeps true: for the same float32 values it is the same on every machine; what an
// episode has under a name that the other has not does not count. It is for episodes that are given
// twice by mistake, and no defence against one that was made to pass.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "data/traces/trace.hpp"

namespace etlc::data {

/// Of the different units of an input, 32 bits of the hash of each, ascending: the 64 least, and
/// all that are less than 2^28. A unit is a sample of an embedding that is not missing; of a
/// scalar, and of an embedding of few bits, it is a run of 16 samples in which at least 8 differ,
/// since single numbers, and runs in which little happens, are alike in recordings that have
/// nothing to do with each other.
using Sketch = std::vector<std::uint32_t>;

/// Fewer units of an input are evidence only where no input has as many.
inline constexpr std::size_t kLeastUnits = 8;
/// A single unit in common is none: many episodes begin alike.
inline constexpr std::uint32_t kFewestInCommon = 2;

/// Two that have fewer units in common than the lesser of this of both do not overlap.
inline std::uint32_t fewest_in_common(const Sketch& sketch) {
    return sketch.size() < kLeastUnits ? kFewestInCommon : kLeastUnits / 2 + 1;
}

struct InputContent {
    std::string hash;  ///< of all samples in order, 16 hex digits
    Sketch sketch;
};

template <class Archive>
void fields(Archive& archive, InputContent& content) {
    archive(content.hash, content.sketch);
}

/// By name of the input.
using EpisodeContent = std::map<std::string, InputContent>;

/// Reads an input's samples along.
class ContentReader {
public:
    /// `tells_alone`: a unit is one sample; else a run of them.
    explicit ContentReader(bool tells_alone) : tells_alone_(tells_alone) {}

    /// The next sample, as the bits of float32: `EpisodeHash` says which.
    void add(const std::uint32_t* bits, std::size_t n, bool present);
    InputContent content() const;

private:
    static constexpr std::size_t kRun = 16;

    void add_unit(std::uint64_t hash);
    bool run_tells() const;

    bool tells_alone_;
    std::uint64_t steps_ = 0;
    std::uint64_t present_ = 0;  ///< samples that are not missing
    std::uint64_t hash_ = 0;
    /// The last samples, by step modulo kRun: a number, or the hash of several.
    std::array<std::uint32_t, kRun> run_{};
    std::vector<std::uint32_t> units_;     ///< of which there may be some twice
    std::uint32_t greatest_ = UINT32_MAX;  ///< units above it are not kept
    std::size_t room_ = 2048;              ///< units before they are sifted
};

/// How much of the smaller of two episodes is in the other.
struct Overlap {
    std::size_t other = 0;  ///< which one, in the order of `Recordings::add`
    double share = 0;       ///< of the units; estimated, unless they are equal
    bool equal = false;     ///< all samples of all inputs that both have
};

/// Which episodes have a key: some 25 bytes for each that has one.
class EpisodesByKey {
public:
    void add(std::uint64_t key, std::uint32_t episode);

    /// In no order.
    template <class Visit>
    void for_each(std::uint64_t key, const Visit& visit) const {
        if (first_.empty()) return;
        for (std::uint32_t i = first_[slot(key)]; i != kNone; i = entries_[i].next)
            if (entries_[i].key == key) visit(entries_[i].episode);
    }

private:
    static constexpr std::uint32_t kNone = UINT32_MAX;
    struct Entry {
        std::uint64_t key;
        std::uint32_t episode;
        std::uint32_t next;  ///< of the same slot
    };

    std::size_t slot(std::uint64_t key) const { return (key ^ key >> 32U) & (first_.size() - 1); }
    void grow();

    std::vector<Entry> entries_;
    std::vector<std::uint32_t> first_;  ///< by slot; as many as a power of two
};

/// Episodes among which others are looked for. What an episode takes does not depend on how many
/// there are.
class Recordings {
public:
    void add(const EpisodeContent& content);
    /// One that is equal; else the first with which more than half of the smaller of both is
    /// shared, in every input that both have and that has enough units; where none has, in every
    /// input that has two and of which nothing was left out.
    std::optional<Overlap> find(const EpisodeContent& content) const;

private:
    std::vector<EpisodeContent> all_;
    /// Per input: by hash, and by unit, the episodes that have it.
    std::map<std::string, EpisodesByKey> by_hash_;
    std::map<std::string, EpisodesByKey> by_unit_;
};

/// Of the smaller sketch; nothing where it has fewer than `least` units.
std::optional<double> share(const Sketch& a, const Sketch& b, std::size_t least = kLeastUnits);

}  // namespace etlc::data
