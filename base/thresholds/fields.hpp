// Reading the fields of a JSON tree, and those that every file with episodes behind it has: their
// hashes, what tells them apart, and what --allow-overlap passed over.
// Takes: the tree, and the items that are not in it (thresholds/items.hpp). Gives: values of the
// kinds asked for. Keeps true: the first thing wrong stays in
// `failure_`, and what follows it is not looked at; its message names the key, what was found and
// what was expected.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "data/traces/known.hpp"
#include "diag/diag.hpp"
#include "thresholds/json.hpp"
#include "thresholds/pieces.hpp"

namespace etlc::thresholds {

/// That `--allow-overlap REASON` passed over what would have been refused.
struct Allowance {
    std::string reason;
    std::uint64_t overlapping = 0;  ///< episodes that share most of their content with another
    std::uint64_t leaked = 0;       ///< episodes with a target among their frames
};

/// The newest format of files with episodes behind them. In format 1 these are told apart by the
/// numbers that were stored, in format 2 as the monitor sees them (episodes/recording.hpp).
inline constexpr std::uint32_t kFormat = 2;

class Items;

class Fields {
protected:
    /// The codes of what is not as expected, and of a file of another format.
    Fields(diag::Code invalid, diag::Code unknown_format)
        : invalid_(invalid), unknown_format_(unknown_format) {}

    /// "format": a number from 1 to `newest`.
    std::uint32_t format(const Json& root, std::uint32_t newest);

    /// The value of a key that has to be there and of this kind; null, after a failure, where it is
    /// not. `path`: of the object, in messages.
    const Json* member(const Json& object, const std::string& path, const std::string& key,
                       Json::Kind kind, const std::string& expected);
    std::string text(const Json& object, const std::string& path, const std::string& key);
    /// An object of texts; empty where there is no such key.
    std::map<std::string, std::string> texts(const Json& object, const std::string& path,
                                             const std::string& key);
    std::uint64_t count(const Json& object, const std::string& path, const std::string& key);
    std::uint64_t hash(const Json& json, const std::string& path);
    double score(const Json& json, const std::string& path);
    data::InputContent content(const Json& json, const std::string& path);

    /// The content hashes in the array "episodes", whose items are in `items`.
    std::vector<std::uint64_t> episodes(const Json& object, const std::string& path, Items& items);
    data::KnownEpisodes recordings(const Json& root, Items& items);
    std::vector<Allowance> allowances(const Json& root);

    void check_keys(const Json& object, const std::string& path,
                    const std::vector<std::string>& known);
    void fail(const std::string& place, const Json& found, const std::string& expected);

    std::optional<diag::Failure> failure_;

private:
    diag::Code invalid_;
    diag::Code unknown_format_;
};

/// The other way: JSON text of what the functions of the same names read, `indent` blanks deep.
std::string json_text(const std::string& value);
std::string json_object(const std::map<std::string, std::string>& members, std::size_t indent);
std::string json_texts(std::map<std::string, std::string> texts, std::size_t indent);
std::string json_allowances(const std::vector<Allowance>& all);
void write_episodes(const std::vector<std::uint64_t>& hashes, std::size_t indent, Pieces& to);
void write_recordings(const data::KnownEpisodes& all, Pieces& to);

}  // namespace etlc::thresholds
