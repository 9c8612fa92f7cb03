#include "artifacts/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <unordered_set>

#include "data/text/text.hpp"

namespace etlc::artifacts {
namespace {

using diag::Code;
using diag::Failure;

constexpr std::size_t kPiece = std::size_t{1} << 16U;
constexpr std::size_t kBehind = 4;    ///< bytes of the previous piece that are kept
constexpr int kNumberOverflow = 406;  ///< nlohmann's id of this error

/// An iterator over the bytes of a text, for nlohmann's parser.
class Bytes {
public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = char;

    explicit Bytes(Text* text = nullptr) : text_(text) {}
    char operator*() const { return text_->peek(); }
    Bytes& operator++() {
        text_->advance();
        return *this;
    }
    /// Compares with the end.
    bool operator==(const Bytes&) const { return text_->at_end(); }
    bool operator!=(const Bytes& end) const { return !(*this == end); }

private:
    Text* text_;
};

/// Builds the tree from nlohmann's events.
class Builder {
public:
    Builder(Text& text, std::uint64_t max_values, Code malformed, Code invalid,
            const ItemTakers& takers)
        : text_(text),
          max_values_(max_values),
          malformed_(malformed),
          invalid_(invalid),
          takers_(takers) {}

    bool null() { return leaf(Json::Kind::null, ""); }
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
        Open& object = open_.back();
        if (object.taker.item)
            object.taker.key(name);
        else if (object.seen.insert(name).second)
            object.json->keys.push_back(name);
        else
            throw Fault{repeated_key(invalid_, name)};
        path_.back() = std::move(name);
        return true;
    }

    bool parse_error(std::size_t position, const std::string&,
                     const nlohmann::json::exception& error) {
        // The position counts the bytes read, the unexpected one included.
        const std::uint64_t at = position > 0 ? position - 1 : 0;
        const source::Position place = text_.place(at);
        std::string what = "number outside the range of a double";
        if (error.id != kNumberOverflow) {
            const std::string found = text_.character(at);
            what = found.empty() ? "end" : data::in_quotes(found);
        }
        throw Fault{{malformed_, fmt::format("is not JSON: unexpected {}", what), place.line,
                     place.column}};
    }

    Json take() { return std::move(root_); }

private:
    /// An array or object whose end has not been read.
    struct Open {
        Json* json;
        ItemTaker taker;
        std::uint64_t values;                  ///< number of values up to and including it
        std::size_t taken = 0;                 ///< items
        std::unordered_set<std::string> seen;  ///< keys
    };

    bool leaf(Json::Kind kind, std::string text) {
        Json json;
        json.kind = kind;
        json.text = std::move(text);
        add(std::move(json));
        return complete();
    }

    bool open(Json::Kind kind) {
        if (open_.size() == kMaxJsonDepth)
            throw Fault{{malformed_, fmt::format("nests deeper than {} levels", kMaxJsonDepth)}};
        Json json;
        json.kind = kind;
        Json* added = add(std::move(json));
        ItemTaker taker = takers_ ? takers_(path_, kind) : ItemTaker{};
        if (taker.item) text_.pass(true);
        open_.push_back({added, std::move(taker), values_, 0, {}});
        path_.emplace_back();
        return true;
    }

    bool close() {
        open_.pop_back();
        path_.pop_back();
        return complete();
    }

    /// Passes a complete value on if it is an item.
    bool complete() {
        if (open_.empty() || !open_.back().taker.item) return true;
        Open& in = open_.back();
        const Json item = std::move(in.json->items.back());
        in.json->items.pop_back();
        values_ = in.values;
        text_.pass(in.taker.item(in.taken++, path_.back(), item));
        return true;
    }

    /// Adds a value to the innermost array or object. Pointers to the others stay valid.
    Json* add(Json json) {
        if (values_ == max_values_)
            throw Fault{
                {malformed_,
                 fmt::format("holds more than {} values, the most that are read", max_values_)}};
        ++values_;
        if (open_.empty()) {
            root_ = std::move(json);
            return &root_;
        }
        auto& items = open_.back().json->items;
        items.push_back(std::move(json));
        return &items.back();
    }

    Text& text_;
    std::uint64_t max_values_;
    Code malformed_;
    Code invalid_;
    const ItemTakers& takers_;
    std::uint64_t values_ = 0;
    Json root_;
    std::vector<Open> open_;
    std::vector<std::string> path_;  ///< for each open value the key of its last member
};

}  // namespace

bool Text::next_piece() {
    if (counted_ + read() - passed_ > most_)
        throw Unreadable{
            {{unreadable_,
              fmt::format("is larger than {} bytes without its recordings, the most that is read",
                          most_)}}};
    const std::size_t past = piece_.size() - std::min(piece_.size(), kBehind);
    begin_ += past;
    piece_.erase(0, past);
    at_ = piece_.size();
    return extend();
}

bool Text::extend() {
    const std::size_t before = piece_.size();
    piece_.resize(before + kPiece);
    const auto got = source_.read(piece_.data() + before, kPiece);
    if (!got) {
        diag::Failure failure = got.failure();
        if (failure.code == diag::Code::unreadable_data_file) failure.code = unreadable_;
        throw Unreadable{{failure}};
    }
    piece_.resize(before + *got);
    return piece_.size() > before;
}

std::string Text::character(std::uint64_t at) {
    const auto first = static_cast<std::size_t>(at - begin_);
    if (first + kBehind > piece_.size()) extend();
    if (first >= piece_.size()) return {};
    std::size_t end = first + 1;
    while (end < piece_.size() && end < first + 4 && continues(piece_[end])) ++end;
    return piece_.substr(first, end - first);
}

const Json* Json::find(const std::string& key) const {
    const auto found = std::find(keys.begin(), keys.end(), key);
    return found == keys.end() ? nullptr : &items[static_cast<std::size_t>(found - keys.begin())];
}

Json parse_json(Text& text, std::uint64_t max_values, Code malformed, Code invalid,
                const ItemTakers& takers) {
    Builder builder(text, max_values, malformed, invalid, takers);
    nlohmann::json::sax_parse(Bytes(&text), Bytes(), &builder);
    return builder.take();
}

diag::Result<Json> parse_json(const std::string& text, std::uint64_t max_values, Code code) {
    const auto bytes = data::from_memory(text);
    Text all(*bytes, text.size(), code);
    try {
        return parse_json(all, max_values, code, code);
    } catch (const Fault& fault) {
        return fault.failure;
    }
}

Failure repeated_key(Code code, const std::string& key) {
    return {code, fmt::format("key {} occurs twice in one object", data::in_quotes(key))};
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

}  // namespace etlc::artifacts
