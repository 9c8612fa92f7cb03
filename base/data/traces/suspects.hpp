// Which of many episodes may be equal to another, or share most of their content with one.
// Takes: the content of each. Gives: the suspects among them. Keeps true: of two episodes that
// `Recordings` finds each other by, both are suspects; memory is a few bytes an episode, while
// that of Recordings is a few kilobytes, so it is given the suspects alone.
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
    /// `each_other`: those that are asked about are looked for among each other too.
    explicit Suspects(bool each_other) : each_other_(each_other) {}

    /// One that is asked about.
    void ask(const EpisodeContent& content) { add(content, false); }
    /// One among which they are looked for.
    void know(const EpisodeContent& content) { add(content, true); }

    /// Of each, in the order in which they came, whether it is one.
    std::vector<bool> find();

private:
    /// What two episodes may have in common: a hash or a unit of an input.
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
    /// Calls `visit(episode)` for those of `same`, which have a key in common with another that
    /// they are compared with.
    template <class Visit>
    void for_each_shared(const std::vector<std::uint32_t>& same, const Visit& visit) const;

    bool each_other_;
    std::vector<bool> is_known_;
    std::vector<bool> is_short_;                   ///< has few units in some input
    std::map<std::string, std::uint32_t> inputs_;  ///< by name, their numbers
    Sorted<Key> hashes_;
    Sorted<Key> units_;
};

}  // namespace etlc::data
