#include "artifacts/items.hpp"

#include <fmt/format.h>

#include <charconv>

#include "data/files/hash.hpp"
#include "data/text/text.hpp"

namespace etlc::artifacts {

using diag::Code;
using diag::Failure;

namespace {

double score_of(const Json& json, const std::string& place, Code invalid) {
    const bool infinite =
        json.kind == Json::Kind::string && (json.text == "inf" || json.text == "-inf");
    if (json.kind != Json::Kind::number && !infinite)
        fail(invalid, place, json, "a number, 'inf' or '-inf'");
    return data::parse_number(json.text).value_or(0);
}

}  // namespace

void fail(Code invalid, const std::string& place, const Json& found, const std::string& expected) {
    throw Fault{{invalid, fmt::format("{} is {}, expected {}",
                                      place.empty() ? "the file" : data::in_quotes(place),
                                      describe(found), expected)}};
}

std::uint64_t hash_of(const Json& json, const std::string& place, Code invalid) {
    const auto hash =
        json.kind == Json::Kind::string ? data::hash_of_text(json.text) : std::nullopt;
    if (!hash) fail(invalid, place, json, "a content hash of 16 hex digits");
    return *hash;
}

ItemTakers Items::takers() {
    return [this](const std::vector<std::string>& path, Json::Kind kind) -> ItemTaker {
        const bool is_array = kind == Json::Kind::array;
        if (path.size() == 1 && path[0] == "recordings" && !is_array)
            return {[this](const std::string& key) { note_key(key); },
                    [this](std::size_t, const std::string& key, const Json& item) {
                        return take_recording(key, item);
                    }};
        const bool of_entry = (path.size() == 3 || (path.size() == 4 && path[2] == "inner")) &&
                              (path[0] == "monitors" || path[0] == "predicates");
        if (!is_array || (path.size() != 1 && !of_entry)) return {};
        const std::string place = fmt::format("{}", fmt::join(path, "."));
        const auto take_into = [&](auto& all, auto read) -> ItemTaker {
            return {
                {},
                [this, &found = all[place], place, read](std::size_t index, const std::string&,
                                                         const Json& item) {
                    found.add([&](auto& values) {
                        values.push_back(read(item, fmt::format("{}[{}]", place, index), code_));
                    });
                    return true;
                }};
        };
        if (path.back() == "episodes") return take_into(episodes_, hash_of);
        const std::string& key = path.back();
        const bool is_of_scores = key == "scores" || key == "measured" || key.starts_with("losses");
        if (is_of_scores && of_entry) return take_into(scores_, score_of);
        return {};
    };
}

void Items::note_key(const std::string& key) {
    if (const auto hash = data::hash_of_text(key))
        keys_.add({*hash, keys_.size()});
    else if (!other_keys_.insert(key).second)
        throw Fault{first_repeated().value_or(repeated_key(code_, key))};  // the first one
}

bool Items::take_recording(const std::string& key, const Json& item) {
    const auto hash = data::hash_of_text(key);
    recordings_.add([&](data::KnownEpisodes& recordings) {
        const std::string place = "recordings." + key;
        if (!hash || item.kind != Json::Kind::object)
            fail(code_, place, item, "an object named by a content hash of 16 hex digits");
        data::EpisodeContent of_inputs;
        for (std::size_t k = 0; k < item.keys.size(); ++k)
            of_inputs[item.keys[k]] = content_of(item.items[k], place + "." + item.keys[k]);
        recordings.add(*hash, of_inputs);
    });
    return !hash;
}

namespace {

/// Takes ascending numbers of 8 hex digits from the begin of the text, up to its end or a colon.
bool take_units(std::string_view& text, data::Sketch& units) {
    constexpr std::size_t kDigits = 8;
    while (!text.empty() && text[0] != ':') {
        std::uint32_t unit = 0;
        const char* const end = text.data() + kDigits;
        if (text.size() < kDigits || std::from_chars(text.data(), end, unit, 16).ptr != end ||
            (!units.empty() && units.back() >= unit))
            return false;
        units.push_back(unit);
        text.remove_prefix(kDigits);
    }
    return true;
}

std::optional<data::InputContent> parse_content(std::string_view text) {
    constexpr std::size_t kHash = 16;
    data::InputContent result;
    if (text.size() <= kHash || text[kHash] != ':' || !data::hash_of_text(text.substr(0, kHash)))
        return std::nullopt;
    result.hash = text.substr(0, kHash);
    text.remove_prefix(kHash + 1);
    if (!take_units(text, result.sketch)) return std::nullopt;
    if (text.empty()) return result;
    const bool recurs = text.starts_with(data::kRecurring);
    result.samples = recurs ? data::Samples::recurring : data::Samples::apart;
    text.remove_prefix(recurs ? data::kRecurring.size() : 0);
    if (!recurs && text != data::kApart) return std::nullopt;
    if (recurs && (!take_units(text, result.changes) || !text.empty())) return std::nullopt;
    return result;
}

}  // namespace

data::InputContent Items::content_of(const Json& json, const std::string& place) const {
    auto content = json.kind == Json::Kind::string ? parse_content(json.text) : std::nullopt;
    if (!content)
        fail(code_, place, json,
             fmt::format("16 hex digits, a colon, and ascending numbers of 8 hex digits; for an "
                         "embedding then '{}', or '{}' and such numbers",
                         data::kApart, data::kRecurring));
    return std::move(*content);
}

std::optional<Failure> Items::first_repeated() const {
    std::optional<Key> before;
    std::optional<Key> first;  // the first repeated key
    keys_.for_each([&](const Key& key) {
        if (before && before->hash == key.hash && (!first || key.index < first->index)) first = key;
        before = key;
    });
    if (!first) return std::nullopt;
    return repeated_key(code_, data::hash_text(first->hash));
}

}  // namespace etlc::artifacts
