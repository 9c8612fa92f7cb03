#include "thresholds/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <unordered_set>

#include "data/quote.hpp"
#include "source/source.hpp"

namespace etlc::thresholds {
namespace {

using diag::Code;
using diag::Failure;

constexpr int kNumberOverflow = 406;  ///< nlohmann's id of this error

/// Builds the tree from nlohmann's events. Returning false stops the parser.
class Builder {
public:
    Builder(const std::string& text, std::uint64_t max_values, Code malformed, Code invalid)
        : text_(text), max_values_(max_values), malformed_(malformed), invalid_(invalid) {}

    bool null() { return add({}) != nullptr; }
    bool boolean(bool value) { return leaf(Json::Kind::boolean, value ? "true" : "false"); }
    bool number_integer(std::int64_t value) {
        return leaf(Json::Kind::number, std::to_string(value));
    }
    bool number_unsigned(std::uint64_t value) {
        return leaf(Json::Kind::number, std::to_string(value));
    }
    bool number_float(double, const std::string& written) {
        return leaf(Json::Kind::number, written);
    }
    bool string(std::string& value) { return leaf(Json::Kind::string, std::move(value)); }
    bool binary(nlohmann::json::binary_t&) { return false; }  // JSON text has none

    bool start_object(std::size_t) { return open(Json::Kind::object); }
    bool start_array(std::size_t) { return open(Json::Kind::array); }
    bool end_object() { return close(); }
    bool end_array() { return close(); }

    bool key(std::string& name) {
        if (!seen_.back().insert(name).second) {
            failure_ = Failure{
                invalid_, fmt::format("key {} stands twice in one object", data::in_quotes(name))};
            return false;
        }
        open_.back()->keys.push_back(std::move(name));
        return true;
    }

    bool parse_error(std::size_t position, const std::string&,
                     const nlohmann::json::exception& error) {
        std::string what = "its end";
        if (error.id == kNumberOverflow)
            what = "a number that no double holds";
        else if (position <= text_.size())  // counts the bytes read, the unexpected one included
            what = data::in_quotes(character(position > 0 ? position - 1 : 0));
        const source::Position place = place_of(position);
        failure_ = Failure{malformed_, fmt::format("is no JSON: unexpected {}", what), place.line,
                           place.column};
        return false;
    }

    std::optional<Failure> failure() const { return failure_; }
    Json take() { return std::move(root_); }

private:
    bool leaf(Json::Kind kind, std::string text) {
        Json json;
        json.kind = kind;
        json.text = std::move(text);
        return add(std::move(json)) != nullptr;
    }

    bool open(Json::Kind kind) {
        if (open_.size() == kMaxJsonDepth) {
            failure_ =
                Failure{malformed_, fmt::format("nests deeper than {} levels", kMaxJsonDepth)};
            return false;
        }
        Json json;
        json.kind = kind;
        Json* added = add(std::move(json));
        if (added == nullptr) return false;
        open_.push_back(added);
        seen_.emplace_back();
        return true;
    }

    bool close() {
        open_.pop_back();
        seen_.pop_back();
        return true;
    }

    /// Pointers to open arrays and objects stay good: only the innermost one grows.
    Json* add(Json json) {
        if (values_ == max_values_) {
            failure_ = Failure{
                malformed_,
                fmt::format("holds more than {} values, the most that are read", max_values_)};
            return nullptr;
        }
        ++values_;
        if (open_.empty()) {
            root_ = std::move(json);
            return &root_;
        }
        auto& items = open_.back()->items;
        items.push_back(std::move(json));
        return &items.back();
    }

    static bool continuation(char c) { return (static_cast<unsigned char>(c) & 0xc0U) == 0x80U; }

    /// The UTF-8 character that begins at byte `at`.
    std::string_view character(std::size_t at) const {
        std::size_t end = at + 1;
        while (end < text_.size() && end < at + 4 && continuation(text_[end])) ++end;
        return std::string_view(text_).substr(at, end - at);
    }

    source::Position place_of(std::size_t position) const {
        const std::string_view before =
            std::string_view(text_).substr(0, position > 0 ? position - 1 : 0);
        const auto lines = std::count(before.begin(), before.end(), '\n');
        const std::size_t line_begin = before.rfind('\n') + 1;  // npos + 1 is 0
        const std::string_view line = before.substr(line_begin);
        const auto columns =
            static_cast<std::size_t>(line.end() - line.begin()) -
            static_cast<std::size_t>(std::count_if(line.begin(), line.end(), continuation));
        return {static_cast<std::uint32_t>(lines + 1), static_cast<std::uint32_t>(columns + 1)};
    }

    const std::string& text_;
    std::uint64_t max_values_;
    Code malformed_;
    Code invalid_;
    std::uint64_t values_ = 0;
    Json root_;
    std::vector<Json*> open_;
    std::vector<std::unordered_set<std::string>> seen_;  ///< keys of each open object
    std::optional<Failure> failure_;
};

}  // namespace

const Json* Json::find(const std::string& key) const {
    const auto found = std::find(keys.begin(), keys.end(), key);
    return found == keys.end() ? nullptr : &items[static_cast<std::size_t>(found - keys.begin())];
}

diag::Result<Json> parse_json(const std::string& text, std::uint64_t max_values, Code malformed,
                              Code invalid) {
    Builder builder(text, max_values, malformed, invalid);
    nlohmann::json::sax_parse(text, &builder);
    if (auto failure = builder.failure()) return *failure;
    return builder.take();
}

std::string describe(const Json& json) {
    switch (json.kind) {
        case Json::Kind::null: return "null";
        case Json::Kind::boolean: return json.text;
        case Json::Kind::number: return data::in_quotes(json.text);
        case Json::Kind::string: return fmt::format("the text {}", data::in_quotes(json.text));
        case Json::Kind::array: return "an array";
        case Json::Kind::object: return "an object";
    }
    return "nothing";
}

}  // namespace etlc::thresholds
