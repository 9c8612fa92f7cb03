// Finds out whether an episode is the same recording as another, or a part of it.
// Takes: the samples of each input, a step after the other. Gives: per input a hash of all samples,
// and a sketch, a sample of hashes from which the share of equal content is estimated. Keeps true:
// the same float32 values give the same result on every machine; inputs that only one episode has
// do not count; an embedding decides by itself, whatever scalars were recorded with it. This
// detects episodes given twice by mistake; it is no defence against one that was manipulated to
// pass.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data/spill/spill.hpp"
#include "data/traces/trace.hpp"

namespace etlc::data {

/// 32 bits of the hash of each different unit of an input, ascending: the 64 least, and all below
/// 2^28. A unit of an embedding is a sample that is not missing. A unit of a scalar, or of an
/// embedding of few bits, is a run of 16 samples in which at least 8 differ, since single numbers,
/// and runs in which little happens, also agree in unrelated recordings.
using Sketch = std::vector<std::uint32_t>;

/// Fewer units are evidence only if all of both episodes are compared.
inline constexpr std::size_t kLeastUnits = 8;
/// A single unit in common is no evidence: many episodes begin alike.
inline constexpr std::uint32_t kFewestInCommon = 2;

/// Two episodes do not overlap if they have fewer units in common than the lesser of their values.
inline std::uint32_t fewest_in_common(const Sketch& sketch) {
    return sketch.size() < kLeastUnits ? kFewestInCommon : kLeastUnits / 2 + 1;
}

/// How far the samples of an input identify an episode.
enum class Samples : std::uint8_t {
    runs,       ///< of a scalar, or of few bits: only runs of them tell
    apart,      ///< of an embedding: each tells
    recurring,  ///< of an embedding with so few different ones that other recordings may have them
};

/// How files write the last two.
inline constexpr std::string_view kApart = ":apart";
inline constexpr std::string_view kRecurring = ":recurring:";

struct InputContent {
    std::string hash;  ///< of all samples in order, 16 hex digits
    Sketch sketch;
    Samples samples = Samples::runs;
    /// Recurring samples: of the order and the times in which they follow each other. A unit is a
    /// change of the sample and the time for which each of the samples before stayed, as many as
    /// together last for 16 steps.
    Sketch changes{};
};

template <class Archive>
void fields(Archive& archive, InputContent& content) {
    archive(content.hash, content.sketch, content.samples, content.changes);
}

/// By name of the input.
using EpisodeContent = std::map<std::string, InputContent>;

/// Makes a sketch of units, which are added one after the other.
class Sketching {
public:
    void add(std::uint64_t hash);
    Sketch sketch() const;

private:
    std::vector<std::uint32_t> units_;     ///< may contain duplicates
    std::uint32_t greatest_ = UINT32_MAX;  ///< units above it are not kept
    std::size_t room_ = 2048;              ///< units before they are sifted
};

/// Makes the content of an input from its samples, one after the other.
class ContentReader {
public:
    /// `tells_alone`: a unit is one sample; else a run of samples.
    explicit ContentReader(bool tells_alone) : tells_alone_(tells_alone) {}

    /// Adds a sample as the bits of float32, as `EpisodeHash` passes them.
    void add(const std::uint32_t* bits, std::size_t n, bool present);
    InputContent content() const;

private:
    static constexpr std::size_t kRun = 16;

    /// A sample that did not change for some steps.
    struct Stay {
        std::uint64_t sample = 0;
        std::uint64_t steps = 0;
    };

    /// An embedding of as many different samples as this tells by each of them.
    static constexpr std::size_t kManySamples = 16;

    bool run_tells() const;
    /// Adds the next sample of an embedding to what tells of the order.
    void follow(std::uint64_t sample, bool present);

    bool tells_alone_;
    std::uint64_t steps_ = 0;
    std::uint64_t present_ = 0;  ///< samples that are not missing
    std::uint64_t hash_ = 0;
    /// The last samples, by step modulo kRun: a number, or the hash of several.
    std::array<std::uint32_t, kRun> run_{};
    Sketching units_;
    std::vector<std::uint64_t> different_;  ///< samples, kManySamples at most
    Stay stay_;                             ///< at the present sample
    std::vector<Stay> earlier_;             ///< the last ones whose begin was seen, kRun at most
    Sketching changes_;
};

/// The share of the smaller of two episodes that is in the other.
struct Overlap {
    std::size_t other = 0;  ///< index of the other in the order of `Recordings::add`
    double share = 0;       ///< share of the units; estimated, unless the episodes are equal
    /// All samples of all embeddings that both have are equal, or of all inputs where no embedding
    /// tells.
    bool equal = false;
};

/// The episodes that have a key, in some 25 bytes each.
class EpisodesByKey {
public:
    void add(std::uint64_t key, std::uint32_t episode);

    /// Visits the episodes that have the key, in no particular order.
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
        std::uint32_t next;  ///< next entry of the slot
    };

    std::size_t slot(std::uint64_t key) const { return (key ^ key >> 32U) & (first_.size() - 1); }
    void grow();

    std::vector<Entry> entries_;
    std::vector<std::uint32_t> first_;  ///< by slot; as many as a power of two
};

/// Episodes that others are compared with. The cost of an episode does not depend on their number.
class Recordings {
public:
    void add(const EpisodeContent& content);
    /// Finds an equal episode; else the first that shares more than half of the smaller of both in
    /// some common embedding; where no common embedding tells, in every common input that has
    /// enough units.
    std::optional<Overlap> find(const EpisodeContent& content) const;

private:
    std::vector<EpisodeContent> all_;
    /// Per input: by hash, and by unit, the episodes that have it.
    std::map<std::string, EpisodesByKey> by_hash_;
    std::map<std::string, EpisodesByKey> by_unit_;
};

/// Returns the share of the smaller sketch; nothing where it has fewer than `least` units.
std::optional<double> share(const Sketch& a, const Sketch& b, std::size_t least = kLeastUnits);

// The contents of many episodes by their hashes.
// Takes: hashes and contents, in any order. Gives: them in ascending order of the hashes, each
// once, the last that was added. Keeps true: contents are in temporary files, and memory is 8 bytes
// for each; a copy costs nothing until one of the two changes. Not thread-safe.

class KnownEpisodes {
public:
    void add(std::uint64_t hash, const EpisodeContent& content);
    bool empty() const { return all_ == nullptr || all_->places.size() == 0; }

    using Visit = std::function<void(std::uint64_t hash, const EpisodeContent& content)>;
    void for_each(const Visit& visit) const;
    /// Visits only those among `hashes`, which are sorted.
    void for_each_of(const std::vector<std::uint64_t>& hashes, const Visit& visit) const;

    /// Forgets all that are not among `hashes`, which are sorted.
    void keep(const std::vector<std::uint64_t>& hashes);

private:
    struct Place {
        std::uint64_t hash;
        std::uint64_t at;  ///< its place in `contents`
        bool operator<(const Place& other) const {
            return hash != other.hash ? hash < other.hash : at < other.at;
        }
    };
    struct All {
        Spool<EpisodeContent> contents;
        Sorted<Place> places;
    };

    std::shared_ptr<All> all_;  ///< shared by copies until one of them changes
};

// Preselects the episodes that may be equal to another, or share most of their content with one.
// Takes: the content of each. Gives: the suspects. Keeps true: if `Recordings` finds one of two
// episodes by the other, both are suspects; an episode takes a few bytes here and a few kilobytes
// in Recordings, so only suspects are compared there.

class Suspects {
public:
    /// `each_other`: episodes that are asked about are also compared with each other.
    explicit Suspects(bool each_other) : each_other_(each_other) {}

    /// Adds an episode that is asked about.
    void ask(const EpisodeContent& content) { add(content, false); }
    /// Adds an episode that they are compared with.
    void know(const EpisodeContent& content) { add(content, true); }

    /// Returns for each episode, in the order of the calls, whether it is a suspect.
    std::vector<bool> find();

private:
    /// A hash or a unit of an input, which two episodes may have in common.
    struct Key {
        std::uint64_t key;
        std::uint32_t input;
        std::uint32_t episode;
        bool operator<(const Key& other) const {
            if (input != other.input) return input < other.input;
            return key != other.key ? key < other.key : episode < other.episode;
        }
    };
    void add(const EpisodeContent& content, bool is_known);
    bool are_compared(std::uint32_t a, std::uint32_t b) const {
        return is_known_[a] != is_known_[b] || (each_other_ && !is_known_[a]);
    }
    /// Visits the episodes of `same` that have a key in common with one they are compared with.
    template <class Visit>
    void for_each_shared(const std::vector<std::uint32_t>& same, const Visit& visit) const;

    bool each_other_;
    std::vector<bool> is_known_;
    std::vector<bool> is_short_;                   ///< has few units in some input
    std::map<std::string, std::uint32_t> inputs_;  ///< numbers by name
    Sorted<Key> hashes_;
    Sorted<Key> units_;
};

}  // namespace etlc::data
