#include "thresholds/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <nlohmann/json.hpp>

#include "data/quote.hpp"

namespace etlc::thresholds {

using data::in_quotes;
using diag::Failure;

namespace {

bool is_hash(const std::string& text) {
    const auto hex = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
    return text.size() == 16 && std::all_of(text.begin(), text.end(), hex);
}

}  // namespace

std::string Fields::hash(const Json& json, const std::string& path) {
    if (json.kind != Json::Kind::string || !is_hash(json.text))
        fail(path, json, "a content hash of 16 hex digits");
    return json.text;
}

std::string Fields::text(const Json& object, const std::string& path, const std::string& key) {
    const Json* value = member(object, path, key, Json::Kind::string, "a text");
    return value != nullptr ? value->text : std::string();
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

void Fields::check_format(const Json& root) {
    const Json* format = member(root, "", "format", Json::Kind::number, "1");
    if (format != nullptr && format->text != "1")
        failure_ = Failure{unknown_format_,
                           fmt::format("'format' is {}, expected 1, the one this version reads",
                                       in_quotes(format->text))};
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

std::vector<std::string> Fields::episodes(const Json& object, const std::string& path) {
    const Json* array =
        member(object, path, "episodes", Json::Kind::array, "an array of content hashes");
    std::vector<std::string> result;
    for (std::size_t i = 0; array != nullptr && i < array->items.size() && !failure_; ++i)
        result.push_back(hash(array->items[i],
                              fmt::format("{}{}episodes[{}]", path, path.empty() ? "" : ".", i)));
    return result;
}

std::map<std::string, data::EpisodeContent> Fields::recordings(const Json& root) {
    const Json* object = member(root, "", "recordings", Json::Kind::object, "an object");
    std::map<std::string, data::EpisodeContent> result;
    for (std::size_t i = 0; object != nullptr && i < object->keys.size() && !failure_; ++i) {
        const std::string place = "recordings." + object->keys[i];
        const Json& inputs = object->items[i];
        if (!is_hash(object->keys[i]) || inputs.kind != Json::Kind::object)
            fail(place, inputs, "an object named by a content hash of 16 hex digits");
        data::EpisodeContent& of_inputs = result[object->keys[i]];
        for (std::size_t k = 0; k < inputs.keys.size() && !failure_; ++k)
            of_inputs[inputs.keys[k]] = content(inputs.items[k], place + "." + inputs.keys[k]);
    }
    return result;
}

data::InputContent Fields::content(const Json& json, const std::string& path) {
    constexpr std::size_t kHash = 16;
    constexpr std::size_t kUnit = 8;
    const std::string& digits = json.text;
    data::InputContent result;
    bool sound = json.kind == Json::Kind::string && digits.size() > kHash && digits[kHash] == ':' &&
                 digits.size() % kUnit == 1 && is_hash(digits.substr(0, kHash));
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

std::string json_episodes(const std::vector<std::string>& hashes, std::size_t indent) {
    if (hashes.empty()) return "[]";
    std::string result = "[";
    for (const std::string& hash : hashes)
        result += fmt::format("{}\n{:{}}{}", result.size() > 1 ? "," : "", "", indent + 2,
                              json_text(hash));
    return result + fmt::format("\n{:{}}]", "", indent);
}

/// Per episode and input, the hash, a colon and the sketch, eight digits a unit.
std::string json_recordings(const std::map<std::string, data::EpisodeContent>& all) {
    std::map<std::string, std::string> members;
    for (const auto& [hash, content] : all) {
        std::map<std::string, std::string> inputs;
        for (const auto& [name, of_input] : content) {
            std::string digits = of_input.hash + ":";
            for (const std::uint32_t unit : of_input.sketch)
                fmt::format_to(std::back_inserter(digits), "{:08x}", unit);
            inputs[name] = json_text(digits);
        }
        members[hash] = json_object(inputs, 4);
    }
    return json_object(members, 2);
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
