// Reads the members of a JSON object. The first error is thrown as a Fault, whose message names the
// key, what was found and what was expected. All numbers are finite; no array takes more memory
// than its file, and all arrays together no more than 256 MiB.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "artifacts/items.hpp"
#include "data/arrays/archive.hpp"
#include "data/arrays/array.hpp"

namespace etlc::artifacts {

/// When a file has a member.
enum class Presence : std::uint8_t {
    always,
    where_any,  ///< unless it is empty
};

// Kinds of text.
struct Hash {};  ///< a content hash: 16 hex digits
struct Words {
    std::vector<std::string> known;  ///< the words allowed
};
/// A float32 that may be infinite.
struct OrInfinite {
    bool allowed = true;
};
struct Decimal {  ///< a JSON number as written; left out if empty
    bool required;
    std::string expected;
};

/// A float32 array of the archive.
struct Array {
    std::string name;                  ///< used for writing
    std::vector<std::uint64_t> shape;  ///< for reading, only the rank is used
    std::string meaning;               ///< of the dimensions: "rows x dimension"
};

/// A kind of file, and the codes of its faults.
struct Kind {
    std::string member;   ///< member of the archive that describes it, "fitted.json"; or empty
    std::string command;  ///< the command that writes it: "etlc fit"
    std::uint32_t format;
    diag::Code malformed;
    diag::Code unknown_format;
    diag::Code invalid;
    diag::Code unreadable;
};

/// Collects the keys that an object may have.
struct Keys {
    static constexpr bool kReads = false;
    std::vector<std::string> names;

    template <class... Rest>
    std::vector<std::uint64_t> operator()(const std::string& key, const Rest&...) {
        names.push_back(key);
        return {};
    }
};

/// A function `members(archive, ...)` describes an object once, for reading and for writing: it
/// calls the archive, which is a Keys, a Reader or a Writer, with the key and the value of each
/// member, in the order of the file.
class Reader {
public:
    static constexpr bool kReads = true;

    /// The state that all readers of a file share.
    struct Shared {
        const Kind& kind;
        Items& items;
        const data::Archive* archive = nullptr;
        std::uint64_t bytes_of_arrays = 0;  ///< so far
    };

    /// `path` is the object's in messages.
    Reader(Shared& shared, const Json& object, std::string path);

    /// Reads all members. Throws if there are others than these and those `known`.
    template <class Members>
    void read(const Members& members, Keys known = {}) {
        members(known);
        check_keys(known.names);
        members(*this);
    }
    /// Reads the root object of a file.
    template <class Members>
    void read_file(const Members& members) {
        check_format();
        read(members, {{"format"}});
    }

    void operator()(const std::string& key, std::string& text);
    void operator()(const std::string& key, std::string& word, const Words& words,
                    Presence presence = Presence::always);
    void operator()(const std::string& key, std::string& hash, Hash);
    void operator()(const std::string& key, std::uint64_t& hash, Hash);
    void operator()(const std::string& key, std::string& number, const Decimal& decimal);
    void operator()(const std::string& key, std::uint64_t& count,
                    Presence presence = Presence::always);
    void operator()(const std::string& key, float& number, OrInfinite infinite = {false});
    void operator()(const std::string& key, std::map<std::string, std::string>& texts,
                    Presence presence);
    void operator()(const std::string& key, std::map<std::string, std::string>& hashes, Hash,
                    Presence presence = Presence::always);
    void operator()(const std::string& key, std::vector<double>& scores,
                    Presence presence = Presence::always);
    void operator()(const std::string& key, std::vector<std::uint64_t>& episodes, Presence);
    void operator()(const std::string& key, data::KnownEpisodes& recordings, Presence);
    /// Reads an array of finite float32 without a dimension of 0. Returns its shape.
    std::vector<std::uint64_t> operator()(const std::string& key, const Array& array,
                                          std::vector<float>& values,
                                          Presence presence = Presence::always);

    /// Reads an object of objects, each of which `members(archive, name, value)` describes.
    template <class T, class Members>
    void operator()(const std::string& key, std::map<std::string, T>& objects,
                    const Members& members, Presence presence = Presence::always) {
        const Json* all = find(key, Json::Kind::object, "an object", presence);
        for (std::size_t i = 0; all != nullptr && i < all->keys.size(); ++i) {
            T& value = objects[all->keys[i]];
            Reader(shared_, all->items[i], place(key) + "." + all->keys[i])
                .read([&](auto& archive) { members(archive, all->keys[i], value); });
        }
    }
    /// Reads an object that may be missing, which `members(archive, value)` describes.
    template <class T, class Members>
    void operator()(const std::string& key, std::optional<T>& object, const Members& members) {
        const Json* one = find(key, Json::Kind::object, "an object", Presence::where_any);
        if (one == nullptr) return;
        T& value = object.emplace();
        Reader(shared_, *one, place(key)).read([&](auto& archive) { members(archive, value); });
    }
    /// Reads an array of objects, each of which `members(archive, value)` describes.
    template <class T, class Members>
    void operator()(const std::string& key, std::vector<T>& rows, const std::string& expected,
                    const Members& members, Presence presence = Presence::always) {
        const Json* all = find(key, Json::Kind::array, expected, presence);
        for (std::size_t i = 0; all != nullptr && i < all->items.size(); ++i) {
            T& value = rows.emplace_back();
            Reader(shared_, all->items[i], place(key) + "[" + std::to_string(i) + "]")
                .read([&](auto& archive) { members(archive, value); });
        }
    }

    const Json* find(const std::string& key) const { return object_.find(key); }
    /// Returns the path of a key, "entries.Q.array"; without a key that of the object.
    std::string place(const std::string& key) const;
    /// Throws that the value of an existing key is not as expected.
    [[noreturn]] void refuse(const std::string& key, const std::string& expected) const {
        fail(shared_.kind.invalid, place(key), *find(key), expected);
    }
    [[noreturn]] void refuse(const std::string& message) const {
        throw Fault{{shared_.kind.invalid, message}};
    }

private:
    void check_format() const;
    void check_keys(const std::vector<std::string>& known) const;
    /// Returns null if an optional member is missing.
    const Json* find(const std::string& key, Json::Kind kind, const std::string& expected,
                     Presence presence) const;
    const Json& get(const std::string& key, Json::Kind kind, const std::string& expected) const {
        return *find(key, kind, expected, Presence::always);
    }
    data::Array read_array(const std::string& name);

    Shared& shared_;
    const Json& object_;
    std::string path_;
};

}  // namespace etlc::artifacts
