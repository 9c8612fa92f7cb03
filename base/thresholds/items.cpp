#include "thresholds/items.hpp"

#include <fmt/format.h>

#include "data/files/hash.hpp"
#include "data/text/number.hpp"
#include "data/text/quote.hpp"

namespace etlc::thresholds {

using diag::Failure;

namespace {

std::string joined(const std::vector<std::string>& path) {
    return fmt::format("{}", fmt::join(path, "."));
}

Failure stands_twice(diag::Code code, const std::string& key) {
    return {code, fmt::format("key {} stands twice in one object", data::in_quotes(key))};
}

}  // namespace

ItemTakers Items::takers() {
    return [this](const std::vector<std::string>& path, Json::Kind kind) -> ItemTaker {
        const bool is_array = kind == Json::Kind::array;
        if (path.size() == 1 && path[0] == "recordings" && !is_array)
            return {[this](const std::string& key) { return note_key(key); },
                    [this](std::size_t, const std::string& key, const Json& item) {
                        return take_recording(key, item);
                    }};
        const bool of_entry =
            path.size() == 3 && (path[0] == "monitors" || path[0] == "predicates");
        if (!is_array || (path.size() != 1 && !of_entry)) return {};
        const std::string place = joined(path);
        const auto take_into = [&](auto& all, auto read) -> ItemTaker {
            return {{},
                    [this, &found = all[place], place, read](std::size_t index, const std::string&,
                                                             const Json& item) {
                        if (found.failure) return Taken{true, {}};
                        found.values.push_back(
                            (this->*read)(item, fmt::format("{}[{}]", place, index)));
                        found.failure = std::exchange(failure_, std::nullopt);
                        return Taken{true, {}};
                    }};
        };
        if (path.back() == "episodes") return take_into(episodes_, &Items::hash);
        if (path.back() == "scores" && of_entry) return take_into(scores_, &Items::score);
        return {};
    };
}

std::optional<Failure> Items::note_key(const std::string& key) {
    if (const auto hash = data::hash_of_text(key))
        keys_.add({*hash, keys_.size()});
    else if (!other_keys_.insert(key).second)
        return twice().value_or(stands_twice(code_, key));  // the first of all
    return std::nullopt;
}

Taken Items::take_recording(const std::string& key, const Json& item) {
    const auto hash = data::hash_of_text(key);
    const bool keeps = !hash;
    if (recordings_.failure) return {keeps, {}};
    const std::string place = "recordings." + key;
    if (!hash || item.kind != Json::Kind::object)
        fail(place, item, "an object named by a content hash of 16 hex digits");
    data::EpisodeContent of_inputs;
    for (std::size_t k = 0; k < item.keys.size() && !failure_; ++k)
        of_inputs[item.keys[k]] = content(item.items[k], place + "." + item.keys[k]);
    recordings_.failure = std::exchange(failure_, std::nullopt);
    if (!recordings_.failure) recordings_.values.add(*hash, of_inputs);
    return {keeps, {}};
}

std::optional<Failure> Items::twice() const {
    std::optional<Key> before;
    std::optional<Key> first;  // that another stands before
    keys_.for_each([&](const Key& key) {
        if (before && before->hash == key.hash && (!first || key.index < first->index)) first = key;
        before = key;
    });
    if (!first) return std::nullopt;
    return stands_twice(code_, data::hash_text(first->hash));
}

}  // namespace etlc::thresholds
