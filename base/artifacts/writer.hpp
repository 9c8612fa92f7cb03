// Writes the members of a JSON object as Reader reads them, with two blanks of indentation a level.
// Memory is that of a piece of text.
#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "artifacts/reader.hpp"
#include "data/arrays/archive.hpp"
#include "data/traces/overlap.hpp"

namespace etlc::artifacts {

/// Collects text and passes it on in pieces.
class Pieces {
public:
    /// Returns whether it took the text.
    using Take = std::function<bool(std::string_view)>;

    explicit Pieces(Take take) : take_(std::move(take)) {}

    void add(std::string_view text) {
        piece_ += text;
        if (piece_.size() >= kPiece) pass_on();
    }
    /// Returns whether all text was taken.
    bool finish() {
        pass_on();
        return taken_;
    }

private:
    static constexpr std::size_t kPiece = std::size_t{1} << 16U;

    void pass_on() {
        taken_ = taken_ && take_(piece_);
        piece_.clear();
    }

    Take take_;
    std::string piece_;
    bool taken_ = true;
};

/// Writes one object. Its operators correspond to those of Reader.
class Writer {
public:
    static constexpr bool kReads = false;

    /// `indent` is the number of blanks before the closing brace. `arrays` receives the arrays.
    /// `in_line` puts the object on one line.
    Writer(Pieces& to, std::size_t indent, std::vector<data::ArchiveMember>* arrays = nullptr,
           bool in_line = false)
        : to_(to), indent_(indent), arrays_(arrays), in_line_(in_line) {}

    void operator()(const std::string& key, const std::string& text);
    void operator()(const std::string& key, const std::string& word, const Words&,
                    Presence presence = Presence::always) {
        if (presence == Presence::always || !word.empty()) (*this)(key, word);
    }
    void operator()(const std::string& key, const std::string& hash, Hash) { (*this)(key, hash); }
    void operator()(const std::string& key, std::uint64_t hash, Hash);
    void operator()(const std::string& key, const std::string& number, const Decimal&);
    template <std::unsigned_integral Number>
    void operator()(const std::string& key, Number count, Presence presence = Presence::always) {
        if (presence == Presence::always || count > 0) write(key, std::to_string(count));
    }
    void operator()(const std::string& key, float number, OrInfinite = {});
    void operator()(const std::string& key, const std::map<std::string, std::string>& texts,
                    Presence presence);
    void operator()(const std::string& key, const std::map<std::string, std::string>& hashes, Hash,
                    Presence presence = Presence::always) {
        (*this)(key, hashes, presence);
    }
    void operator()(const std::string& key, const std::vector<double>& scores,
                    Presence presence = Presence::always);
    void operator()(const std::string& key, const std::vector<std::uint64_t>& episodes, Presence);
    void operator()(const std::string& key, const data::KnownEpisodes& recordings, Presence);
    std::vector<std::uint64_t> operator()(const std::string& key, const Array& array,
                                          const std::vector<float>& values,
                                          Presence presence = Presence::always);

    template <class T, class Members>
    void operator()(const std::string& key, const std::map<std::string, T>& objects,
                    const Members& members, Presence = Presence::always) {
        begin(key);
        Writer all(to_, indent_ + 2, arrays_);
        for (const auto& [name, value] : objects) {
            all.begin(name);
            Writer one(to_, indent_ + 4, arrays_);
            members(one, name, value);
            one.end();
        }
        all.end();
    }
    template <class T, class Members>
    void operator()(const std::string& key, const std::optional<T>& object,
                    const Members& members) {
        if (!object) return;
        begin(key);
        Writer one(to_, indent_ + 2, arrays_);
        members(one, *object);
        one.end();
    }
    template <class T, class Members>
    void operator()(const std::string& key, const std::vector<T>& rows, const std::string&,
                    const Members& members, Presence presence = Presence::always) {
        if (rows.empty() && presence == Presence::where_any) return;
        write_rows(key, rows.size(), [&](std::size_t i) {
            Writer one(to_, indent_ + 4, nullptr, true);
            members(one, rows[i]);
            one.end();
        });
    }

    void end();

private:
    void begin(const std::string& key);
    void write(const std::string& key, std::string_view json);
    void write_rows(const std::string& key, std::size_t size,
                    const std::function<void(std::size_t)>& write_row);

    Pieces& to_;
    std::size_t indent_;
    std::vector<data::ArchiveMember>* arrays_;
    bool in_line_;
    bool is_empty_ = true;
};

/// Writes the root object of a file: its format, and the members that `members(writer)` writes.
/// Returns whether all was taken.
template <class Members>
bool write_file(const Pieces::Take& take, std::uint64_t format,
                std::vector<data::ArchiveMember>* arrays, const Members& members) {
    Pieces to(take);
    Writer root(to, 0, arrays);
    root("format", format);
    members(root);
    root.end();
    to.add("\n");
    return to.finish();
}

/// Returns that text as a whole.
template <class Members>
std::string file_text(std::uint64_t format, std::vector<data::ArchiveMember>* arrays,
                      const Members& members) {
    std::string text;
    const auto take = [&](std::string_view piece) {
        text += piece;
        return true;
    };
    write_file(take, format, arrays, members);
    return text;
}

}  // namespace etlc::artifacts
