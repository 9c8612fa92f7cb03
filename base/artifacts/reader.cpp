#include "artifacts/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "data/arrays/array.hpp"
#include "data/files/hash.hpp"
#include "data/text/text.hpp"

namespace etlc::artifacts {

using data::in_quotes;
using diag::Failure;

namespace {

/// Archives with larger arrays are refused.
constexpr std::uint64_t kMaxArrayBytes = 256ULL << 20U;

/// Parses a number; false unless all of the text is one of this type.
template <class Number>
bool is_number(const std::string& text, Number& number) {
    const char* const end = text.data() + text.size();
    const auto [at, error] = std::from_chars(text.data(), end, number);
    return error == std::errc() && at == end;
}

}  // namespace

Reader::Reader(Shared& shared, const Json& object, std::string path)
    : shared_(shared), object_(object), path_(std::move(path)) {
    if (object.kind != Json::Kind::object) fail(shared.kind.invalid, path_, object, "an object");
}

std::string Reader::place(const std::string& key) const {
    if (key.empty()) return path_;
    return path_.empty() ? key : path_ + "." + key;
}

const Json* Reader::find(const std::string& key, Json::Kind kind, const std::string& expected,
                         Presence presence) const {
    const Json* value = find(key);
    if (value == nullptr) {
        if (presence != Presence::always) return nullptr;
        refuse(fmt::format("key {} is missing, expected {}", in_quotes(place(key)), expected));
    }
    if (value->kind != kind) refuse(key, expected);
    return value;
}

void Reader::check_keys(const std::vector<std::string>& known) const {
    for (const std::string& key : object_.keys) {
        if (std::find(known.begin(), known.end(), key) != known.end()) continue;
        std::string message = fmt::format("unknown key {}", in_quotes(place(key)));
        if (auto nearest = diag::nearest_name(key, known))
            message += fmt::format("; did you mean {}?", in_quotes(*nearest));
        refuse(message);
    }
}

void Reader::check_format() const {
    const std::string expected = std::to_string(shared_.kind.format);
    const std::string& found = get("format", Json::Kind::number, expected).text;
    if (found != expected)
        throw Fault{{shared_.kind.unknown_format,
                     fmt::format("'format' is {}, expected {}, the format that this version reads",
                                 in_quotes(found), expected)}};
}

void Reader::operator()(const std::string& key, std::string& text) {
    text = get(key, Json::Kind::string, "a text").text;
}

void Reader::operator()(const std::string& key, std::string& word, const Words& words,
                        Presence presence) {
    if (find(key, Json::Kind::string, "a text", presence) == nullptr) return;
    (*this)(key, word);
    if (std::find(words.known.begin(), words.known.end(), word) != words.known.end()) return;
    std::vector<std::string> quoted;
    for (const std::string& known : words.known) quoted.push_back(in_quotes(known));
    refuse(key, diag::alternatives(quoted));
}

void Reader::operator()(const std::string& key, std::uint64_t& hash, Hash) {
    const Json& value = get(key, Json::Kind::string, "a content hash");
    hash = hash_of(value, place(key), shared_.kind.invalid);
}

void Reader::operator()(const std::string& key, std::string& hash, Hash) {
    std::uint64_t found = 0;
    (*this)(key, found, Hash{});
    hash = data::hash_text(found);
}

void Reader::operator()(const std::string& key, std::string& number, const Decimal& decimal) {
    const Json* value = find(key, Json::Kind::number, decimal.expected,
                             decimal.required ? Presence::always : Presence::where_any);
    if (value != nullptr) number = value->text;
}

void Reader::operator()(const std::string& key, std::uint64_t& count, Presence presence) {
    const Json* value = find(key, Json::Kind::number, "a whole number", presence);
    if (value != nullptr && !is_number(value->text, count)) refuse(key, "a whole number");
}

void Reader::operator()(const std::string& key, float& number, OrInfinite infinite) {
    const Json* value = find(key);
    const bool is_text = value != nullptr && value->kind == Json::Kind::string;
    if (infinite.allowed && is_text && (value->text == "inf" || value->text == "-inf")) {
        number = value->text == "inf" ? HUGE_VALF : -HUGE_VALF;
        return;
    }
    if (!is_number(get(key, Json::Kind::number, "a finite float32").text, number))
        refuse(key, "a finite float32");
}

void Reader::operator()(const std::string& key, std::map<std::string, std::string>& texts,
                        Presence presence) {
    const Json* all = find(key, Json::Kind::object, "an object of texts", presence);
    if (all == nullptr) return;
    Reader inner(shared_, *all, place(key));
    for (const std::string& name : all->keys) inner(name, texts[name]);
}

void Reader::operator()(const std::string& key, std::map<std::string, std::string>& hashes, Hash,
                        Presence presence) {
    const Json* all = find(key, Json::Kind::object, "an object", presence);
    for (std::size_t i = 0; all != nullptr && i < all->keys.size(); ++i)
        hashes[all->keys[i]] = data::hash_text(
            hash_of(all->items[i], place(key) + "." + all->keys[i], shared_.kind.invalid));
}

void Reader::operator()(const std::string& key, std::vector<double>& scores, Presence presence) {
    if (find(key, Json::Kind::array, "an array of numbers", presence) != nullptr)
        scores = shared_.items.scores(place(key));
}

void Reader::operator()(const std::string& key, std::vector<std::uint64_t>& episodes,
                        Presence presence) {
    if (find(key, Json::Kind::array, "an array of content hashes", presence) != nullptr)
        episodes = shared_.items.episodes(place(key));
}

void Reader::operator()(const std::string& key, data::KnownEpisodes& recordings,
                        Presence presence) {
    if (find(key, Json::Kind::object, "an object", presence) != nullptr)
        recordings = shared_.items.recordings();
}

std::vector<std::uint64_t> Reader::operator()(const std::string& key, const Array& array,
                                              std::vector<float>& values, Presence presence) {
    const Json* name = find(key, Json::Kind::string, "a text", presence);
    if (name == nullptr) return {};
    const data::Array found = read_array(name->text);
    const auto wrong = [&](const std::string& what) {
        refuse(fmt::format("array {} {}", in_quotes(name->text), what));
    };
    if (found.element != data::Element::f32)
        wrong(fmt::format("has elements of {}, expected float32", data::name(found.element)));
    if (found.shape.size() != array.shape.size() || found.values.empty())
        wrong(fmt::format("has shape {}, expected {}", found.shape_text(), array.meaning));
    for (std::size_t i = 0; i < found.values.size(); ++i)
        if (!std::isfinite(found.values[i]))
            wrong(
                fmt::format("holds {} at element {}, expected finite numbers", found.values[i], i));
    values.assign(found.values.begin(), found.values.end());
    return found.shape;
}

data::Array Reader::read_array(const std::string& name) {
    const auto source = shared_.archive->member(name);
    if (!source) throw Fault{source.failure()};
    const std::uint64_t size = (*source)->size();
    shared_.bytes_of_arrays += size;
    if (size > kMaxArrayBytes || shared_.bytes_of_arrays > kMaxArrayBytes)
        throw Fault{{diag::Code::array_too_large,
                     fmt::format("the arrays up to {} take more than {} bytes, the most that are "
                                 "read",
                                 in_quotes(name), kMaxArrayBytes)}};
    auto array = data::read_npy_from(**source);
    if (!array) throw Fault{data::in_array(array.failure(), name)};
    return std::move(*array);
}

}  // namespace etlc::artifacts
