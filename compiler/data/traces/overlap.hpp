// What of an episode tells whether another is the same recording, or a part of it.
// Takes: the samples of each input, a step after the other. Gives: per input a hash of all of them,
// and a sketch: a sample of the hashes of what it holds, by which shares of equal content are
// estimated. Keeps true: for the same float32 values it is the same on every machine and in every
// file format; inputs that only one of two episodes has do not count. It is for episodes that are
// given twice by mistake, and no defence against one that was made to pass.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "data/traces/trace.hpp"

namespace etlc::data {

/// Of the different units of an input, 32 bits of the hash of each, ascending: the 64 least, and
/// all that are less than 2^28. A unit is a sample of an embedding; of a scalar it is a run of 16
/// samples in which at least 8 differ, since single numbers, and runs in which little happens, are
/// alike in recordings that have nothing to do with each other.
using Sketch = std::vector<std::uint32_t>;

/// Fewer units are no evidence.
inline constexpr std::size_t kLeastUnits = 8;

struct InputContent {
    std::string hash;  ///< of all samples in order, 16 hex digits
    Sketch sketch;
};

/// By name of the input.
using EpisodeContent = std::map<std::string, InputContent>;

/// Reads an input's samples along.
class ContentReader {
public:
    explicit ContentReader(bool is_vector) : is_vector_(is_vector) {}

    /// The next sample, as the bits of float32: `EpisodeHash` says which.
    void add(const std::uint32_t* bits, std::size_t n);
    InputContent content() const;

private:
    static constexpr std::size_t kRun = 16;

    void add_unit(std::uint64_t hash);
    bool run_tells() const;

    bool is_vector_;
    std::uint64_t steps_ = 0;
    std::uint64_t hash_ = 0;
    std::array<std::uint32_t, kRun> run_{};  ///< the last samples of a scalar, by step modulo kRun
    std::vector<std::uint32_t> units_;       ///< of which there may be some twice
    std::uint32_t greatest_ = UINT32_MAX;    ///< units above it are not kept
    std::size_t room_ = 2048;                ///< units before they are sifted
};

/// How much of the smaller of two episodes is in the other.
struct Overlap {
    std::size_t other = 0;  ///< which one, in the order of `Recordings::add`
    double share = 0;       ///< of the units; estimated, unless they are equal
    bool equal = false;     ///< all samples of all inputs that both have
};

/// Episodes among which others are looked for.
class Recordings {
public:
    void add(const EpisodeContent& content);
    /// One that is equal; else the first with which more than half of the smaller of both is
    /// shared, in every input that both have and that has enough units.
    std::optional<Overlap> find(const EpisodeContent& content) const;

private:
    std::vector<EpisodeContent> all_;
    /// Per input: by hash, and by unit, the episodes that have it.
    std::map<std::string, std::unordered_map<std::string, std::vector<std::size_t>>> by_hash_;
    std::map<std::string, std::unordered_map<std::uint32_t, std::vector<std::size_t>>> by_unit_;
};

/// Of the smaller sketch; nothing where it has too few units.
std::optional<double> share(const Sketch& a, const Sketch& b);

}  // namespace etlc::data
