// The tokens and declarations of the last state of a text.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <variant>

#include "ast/ast.hpp"
#include "parse/stream/tokens.hpp"

namespace etlc::parse {

/// The meaning of a slice: the name in `spec NAME;`, or a declaration.
using Said = std::variant<ast::Name, ast::Declaration>;

/// The slices without errors of one state of a text. A slice of the same text says the same
/// wherever it is, so it need not be parsed again.
class KnownSlices {
public:
    /// Returns what a slice of this text that begins at `begin` says; nothing where it is unknown.
    std::optional<Said> find(std::string_view text, std::uint32_t begin) const {
        const auto found = all_.find(text);
        if (found == all_.end()) return std::nullopt;
        const auto& [said, known_begin] = found->second;
        std::optional<Said> result = said;
        const std::int64_t moved = std::int64_t{begin} - known_begin;
        if (moved != 0) std::visit([&](auto& one) { ast::shift(one, moved); }, *result);
        return result;
    }

    void add(std::string_view text, std::uint32_t begin, Said said) {
        all_.try_emplace(std::string(text), std::move(said), begin);
    }
    /// Takes the slice of this text over from another state.
    void take(std::string_view text, KnownSlices& from) {
        const auto found = from.all_.find(text);
        if (found != from.all_.end()) all_.insert(from.all_.extract(found));
    }

private:
    struct Hash : std::hash<std::string_view> {
        using is_transparent = void;
    };
    std::unordered_map<std::string, std::pair<Said, std::uint32_t>, Hash, std::equal_to<>> all_;
};

/// The tokens of a text, of whose next state only what changed is lexed.
class KnownTokens {
public:
    const Tokens& of(const source::File& file) {
        if (!tokens_.empty() && text_ == file.text()) return tokens_;
        Tokens tokens = std::exchange(tokens_, {});
        update(tokens, std::exchange(text_, {}), file);
        text_ = file.text();
        tokens_ = std::move(tokens);
        return tokens_;
    }

private:
    std::string text_;
    Tokens tokens_;
};

}  // namespace etlc::parse
