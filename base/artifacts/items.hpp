// The items of "episodes", "recordings" and "scores", which are taken as a file is parsed: no tree
// is made of them. The first fault of each array or object is kept until its values are requested.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "artifacts/json.hpp"
#include "data/traces/overlap.hpp"
#include "diag/diag.hpp"

namespace etlc::artifacts {

/// Throws "PLACE is FOUND, expected EXPECTED"; an empty place is the file.
[[noreturn]] void fail(diag::Code invalid, const std::string& place, const Json& found,
                       const std::string& expected);
/// Returns the hash in a JSON text of 16 hex digits, or throws.
std::uint64_t hash_of(const Json& json, const std::string& place, diag::Code invalid);

class Items {
public:
    /// `invalid` is the code of faults.
    explicit Items(diag::Code invalid) : code_(invalid) {}
    Items(const Items&) = delete;
    Items& operator=(const Items&) = delete;

    /// Returns the takers for parse_json(), which these items must outlive.
    ItemTakers takers();
    /// Returns the fault of the first repeated key in "recordings".
    std::optional<diag::Failure> first_repeated() const;

    /// Return the values of the array at `place` ("monitors.reach.episodes") or of "recordings", or
    /// throw the first fault in it.
    std::vector<std::uint64_t> episodes(const std::string& place) {
        return episodes_[place].take();
    }
    std::vector<double> scores(const std::string& place) { return scores_[place].take(); }
    data::KnownEpisodes recordings() { return recordings_.take(); }

private:
    template <class T>
    struct Found {
        T values{};
        std::optional<diag::Failure> failure;

        /// Calls `read(values)` and keeps the fault that it throws.
        template <class Read>
        void add(const Read& read) {
            if (failure) return;
            try {
                read(values);
            } catch (const Fault& fault) {
                failure = fault.failure;
            }
        }
        T take() {
            if (failure) throw Fault{*failure};
            return std::move(values);
        }
    };

    /// A key that is a hash, and its index among the keys.
    struct Key {
        std::uint64_t hash;
        std::uint64_t index;
        bool operator<(const Key& other) const {
            return hash != other.hash ? hash < other.hash : index < other.index;
        }
    };

    void note_key(const std::string& key);
    bool take_recording(const std::string& key, const Json& item);
    data::InputContent content_of(const Json& json, const std::string& place) const;

    diag::Code code_;
    std::map<std::string, Found<std::vector<std::uint64_t>>> episodes_;
    std::map<std::string, Found<std::vector<double>>> scores_;
    Found<data::KnownEpisodes> recordings_;
    mutable data::Sorted<Key> keys_;    ///< keys of "recordings"
    std::set<std::string> other_keys_;  ///< keys that are no hashes
};

}  // namespace etlc::artifacts
