#include "thresholds/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <nlohmann/json.hpp>

#include "data/files/hash.hpp"
#include "data/text/number.hpp"
#include "data/text/quote.hpp"
#include "thresholds/items.hpp"

namespace etlc::thresholds {

using data::in_quotes;
using diag::Failure;

std::uint64_t Fields::hash(const Json& json, const std::string& path) {
    const auto hash =
        json.kind == Json::Kind::string ? data::hash_of_text(json.text) : std::nullopt;
    if (!hash) fail(path, json, "a content hash of 16 hex digits");
    return hash.value_or(0);
}

double Fields::score(const Json& json, const std::string& path) {
    const bool infinite =
        json.kind == Json::Kind::string && (json.text == "inf" || json.text == "-inf");
    if (json.kind == Json::Kind::number || infinite)
        return data::parse_number(json.text).value_or(0);
    fail(path, json, "a number, 'inf' or '-inf'");
    return 0;
}

std::string Fields::text(const Json& object, const std::string& path, const std::string& key) {
    const Json* value = member(object, path, key, Json::Kind::string, "a text");
    return value != nullptr ? value->text : std::string();
}

std::map<std::string, std::string> Fields::texts(const Json& object, const std::string& path,
                                                 const std::string& key) {
    std::map<std::string, std::string> result;
    if (failure_ || object.find(key) == nullptr) return result;
    const Json* texts = member(object, path, key, Json::Kind::object, "an object of texts");
    for (std::size_t i = 0; texts != nullptr && i < texts->keys.size() && !failure_; ++i)
        result[texts->keys[i]] = text(*texts, fmt::format("{}.{}", path, key), texts->keys[i]);
    return result;
}

const Json* Fields::member(const Json& object, const std::string& path, const std::string& key,
                           Json::Kind kind, const std::string& expected) {
    if (failure_) return nullptr;
    const std::string place = path.empty() ? key : fmt::format("{}.{}", path, key);
    const Json* value = object.find(key);
    if (value == nullptr) {
        failure_ = Failure{
            invalid_, fmt::format("key {} is missing, expected {}", in_quotes(place), expected)};
        return nullptr;
    }
    if (value->kind == kind) return value;
    fail(place, *value, expected);
    return nullptr;
}

std::uint32_t Fields::format(const Json& root, std::uint32_t newest) {
    const bool one = newest == 1;
    const std::string expected = one ? "1" : fmt::format("a number from 1 to {}", newest);
    const Json* format = member(root, "", "format", Json::Kind::number, expected);
    if (format == nullptr) return 0;
    for (std::uint32_t known = 1; known <= newest; ++known)
        if (format->text == std::to_string(known)) return known;
    failure_ = Failure{unknown_format_,
                       fmt::format("'format' is {}, expected {}, {} this version reads",
                                   in_quotes(format->text), expected, one ? "the one" : "those")};
    return 0;
}

void Fields::check_keys(const Json& object, const std::string& path,
                        const std::vector<std::string>& known) {
    for (const std::string& key : object.keys) {
        if (failure_) return;
        if (std::find(known.begin(), known.end(), key) != known.end()) continue;
        std::string message = fmt::format(
            "unknown key {}", in_quotes(path.empty() ? key : fmt::format("{}.{}", path, key)));
        if (auto nearest = diag::nearest_name(key, known))
            message += fmt::format("; did you mean {}?", in_quotes(*nearest));
        failure_ = Failure{invalid_, message};
    }
}

void Fields::fail(const std::string& place, const Json& found, const std::string& expected) {
    if (failure_) return;
    const std::string subject = place.empty() ? "the file" : in_quotes(place);
    failure_ =
        Failure{invalid_, fmt::format("{} is {}, expected {}", subject, describe(found), expected)};
}

std::uint64_t Fields::count(const Json& json, const std::string& path, const std::string& key) {
    const std::string expected = "a whole number";
    const Json* value = member(json, path, key, Json::Kind::number, expected);
    if (value == nullptr) return 0;
    std::uint64_t result = 0;
    const std::string& digits = value->text;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), result);
    if (error != std::errc() || end != digits.data() + digits.size())
        fail(path + "." + key, *value, expected);
    return result;
}

std::vector<std::uint64_t> Fields::episodes(const Json& object, const std::string& path,
                                            Items& items) {
    member(object, path, "episodes", Json::Kind::array, "an array of content hashes");
    if (failure_) return {};
    auto found = items.episodes(path.empty() ? "episodes" : path + ".episodes");
    failure_ = std::move(found.failure);
    return std::move(found.values);
}

data::KnownEpisodes Fields::recordings(const Json& root, Items& items) {
    member(root, "", "recordings", Json::Kind::object, "an object");
    if (failure_) return {};
    auto found = items.recordings();
    failure_ = std::move(found.failure);
    return std::move(found.values);
}

data::InputContent Fields::content(const Json& json, const std::string& path) {
    constexpr std::size_t kHash = 16;
    constexpr std::size_t kUnit = 8;
    const std::string& digits = json.text;
    data::InputContent result;
    bool sound = json.kind == Json::Kind::string && digits.size() > kHash && digits[kHash] == ':' &&
                 digits.size() % kUnit == 1 &&
                 data::hash_of_text(digits.substr(0, kHash)).has_value();
    for (std::size_t at = kHash + 1; sound && at < digits.size(); at += kUnit) {
        std::uint32_t unit = 0;
        const char* end = digits.data() + at + kUnit;
        sound = std::from_chars(digits.data() + at, end, unit, 16).ptr == end &&
                (result.sketch.empty() || result.sketch.back() < unit);
        result.sketch.push_back(unit);
    }
    if (!sound)
        fail(path, json, "16 hex digits, a colon, and ascending numbers of 8 hex digits");
    else
        result.hash = digits.substr(0, kHash);
    return result;
}

std::vector<Allowance> Fields::allowances(const Json& root) {
    const Json* array = member(root, "", "allowances", Json::Kind::array, "an array");
    std::vector<Allowance> result;
    for (std::size_t i = 0; array != nullptr && i < array->items.size() && !failure_; ++i) {
        const Json& item = array->items[i];
        const std::string place = fmt::format("allowances[{}]", i);
        if (item.kind != Json::Kind::object) {
            fail(place, item, "an object");
            break;
        }
        check_keys(item, place, {"reason", "overlapping", "leaked"});
        result.push_back({text(item, place, "reason"), count(item, place, "overlapping"),
                          count(item, place, "leaked")});
    }
    return result;
}

std::string json_text(const std::string& value) {
    return nlohmann::json(value).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// `{ members }`, one a line; each is a key and a value that is already JSON.
std::string json_object(const std::map<std::string, std::string>& members, std::size_t indent) {
    if (members.empty()) return "{}";
    std::string result = "{";
    for (const auto& [key, value] : members)
        result += fmt::format("{}\n{:{}}{}: {}", result.size() > 1 ? "," : "", "", indent + 2,
                              json_text(key), value);
    return result + fmt::format("\n{:{}}}}", "", indent);
}

std::string json_texts(std::map<std::string, std::string> texts, std::size_t indent) {
    for (auto& [key, text] : texts) text = json_text(text);
    return json_object(texts, indent);
}

void write_episodes(const std::vector<std::uint64_t>& hashes, std::size_t indent, Pieces& to) {
    if (hashes.empty()) return to.add("[]");
    to.add("[");
    for (std::size_t i = 0; i < hashes.size(); ++i)
        to.add(fmt::format("{}\n{:{}}\"{}\"", i > 0 ? "," : "", "", indent + 2,
                           data::hash_text(hashes[i])));
    to.add(fmt::format("\n{:{}}]", "", indent));
}

/// Per episode and input, the hash, a colon and the sketch, eight digits a unit.
void write_recordings(const data::KnownEpisodes& all, Pieces& to) {
    if (all.empty()) return to.add("{}");
    std::string_view before = "{";
    all.for_each([&](std::uint64_t hash, const data::EpisodeContent& content) {
        std::map<std::string, std::string> inputs;
        for (const auto& [name, of_input] : content) {
            std::string digits = of_input.hash + ":";
            for (const std::uint32_t unit : of_input.sketch)
                fmt::format_to(std::back_inserter(digits), "{:08x}", unit);
            inputs[name] = json_text(digits);
        }
        to.add(fmt::format("{}\n    \"{}\": {}", before, data::hash_text(hash),
                           json_object(inputs, 4)));
        before = ",";
    });
    to.add("\n  }");
}

std::string json_allowances(const std::vector<Allowance>& all) {
    std::string result = "[";
    for (const Allowance& allowance : all)
        result += fmt::format("{}\n    {{ \"reason\": {}, \"overlapping\": {}, \"leaked\": {} }}",
                              result.size() > 1 ? "," : "", json_text(allowance.reason),
                              allowance.overlapping, allowance.leaked);
    return result + "\n  ]";
}

}  // namespace etlc::thresholds
