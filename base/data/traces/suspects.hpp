// Preselects the episodes that may be equal to another, or share most of their content with one.
// Takes: the content of each. Gives: the suspects. Keeps true: if `Recordings` finds one of two
// episodes by the other, both are suspects; an episode takes a few bytes here and a few kilobytes
// in Recordings, so only suspects are compared there.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "data/spill/sorted.hpp"
#include "data/traces/overlap.hpp"

namespace etlc::data {

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
