// What a file has of every episode: hashes, what tells it apart, scores.
// Takes: the items of "episodes", "recordings" and "scores" as the file is read, wherever they may
// stand in a file of thresholds or of fitted things. Gives: their values. Keeps true: no tree is
// made of them; the first fault of each array or object is kept with it, for whoever asks for it.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "data/traces/known.hpp"
#include "diag/diag.hpp"
#include "thresholds/fields.hpp"
#include "thresholds/json.hpp"

namespace etlc::thresholds {

class Items : private Fields {
public:
    /// `invalid`: the code of faults.
    explicit Items(diag::Code invalid) : Fields(invalid, invalid), code_(invalid) {}
    Items(const Items&) = delete;
    Items& operator=(const Items&) = delete;

    /// For parse_json(); these items outlive it.
    ItemTakers takers();
    /// A key that stands twice in "recordings", the first of them.
    std::optional<diag::Failure> twice() const;

    template <class T>
    struct Found {
        T values{};
        std::optional<diag::Failure> failure;
    };
    /// What was read of the array at `place`, "monitors.reach.episodes", or of "recordings".
    Found<std::vector<std::uint64_t>> episodes(const std::string& place) {
        return std::move(episodes_[place]);
    }
    Found<std::vector<double>> scores(const std::string& place) {
        return std::move(scores_[place]);
    }
    Found<data::KnownEpisodes> recordings() { return std::move(recordings_); }

private:
    std::optional<diag::Failure> note_key(const std::string& key);
    Taken take_recording(const std::string& key, const Json& item);

    /// A key that is a hash, and its place among the keys.
    struct Key {
        std::uint64_t hash;
        std::uint64_t index;
        bool operator<(const Key& other) const {
            return hash != other.hash ? hash < other.hash : index < other.index;
        }
    };

    diag::Code code_;
    std::map<std::string, Found<std::vector<std::uint64_t>>> episodes_;
    std::map<std::string, Found<std::vector<double>>> scores_;
    Found<data::KnownEpisodes> recordings_;
    mutable data::Sorted<Key> keys_;    ///< of "recordings"
    std::set<std::string> other_keys_;  ///< that are no hashes
};

}  // namespace etlc::thresholds
