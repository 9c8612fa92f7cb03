// The tokens and declarations of the last state of a text.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

#include "ast/ast.hpp"
#include "parse/stream/tokens.hpp"

namespace etlc::parse {

/// The meaning of a slice: the name in `spec NAME;`, or a declaration.
using Said = std::variant<ast::Name, ast::SharedDeclaration>;

/// The slices without errors of one state of a text, in order. A slice of the same text says the
/// same wherever it is, so it need not be parsed again.
class KnownSlices {
public:
    /// Takes the slice of this text over from another state, and moves it to `begin`. Returns
    /// nothing where it is unknown.
    std::optional<Said> take(std::string_view text, std::uint32_t begin, KnownSlices& from) {
        One* const found = from.find(text);
        if (found == nullptr) return std::nullopt;
        One& one = all_.emplace_back(std::move(*found));
        found->text.clear();
        const std::int64_t moved = std::int64_t{begin} - one.begin;
        one.begin = begin;
        if (moved != 0) shift(one.said, moved);
        return one.said;
    }

    void add(std::string_view text, std::uint32_t begin, Said said) {
        all_.push_back({std::string(text), begin, std::move(said)});
    }

private:
    struct One {
        std::string text;  ///< empty once another state has the slice
        std::uint32_t begin;
        Said said;
    };

    static void shift(Said& said, std::int64_t bytes) {
        if (auto* const name = std::get_if<ast::Name>(&said)) return ast::shift(*name, bytes);
        ast::shift(std::get<ast::SharedDeclaration>(said).changed(), bytes);
    }

    /// Most often the slice follows the one that was found last.
    One* find(std::string_view text) {
        const std::size_t at =
            next_ < all_.size() && all_[next_].text == text ? next_ : place(text);
        if (at >= all_.size() || all_[at].text != text) return nullptr;
        next_ = at + 1;
        return &all_[at];
    }

    /// Searches for a few slices, and has an index for more.
    std::size_t place(std::string_view text) {
        constexpr std::size_t kFew = 8;
        if (++searched_ <= kFew)
            return static_cast<std::size_t>(
                std::find_if(all_.begin(), all_.end(),
                             [&](const One& one) { return one.text == text; }) -
                all_.begin());
        if (places_.empty())
            for (std::size_t i = 0; i < all_.size(); ++i)
                places_.try_emplace(std::hash<std::string_view>()(all_[i].text), i);
        const auto found = places_.find(std::hash<std::string_view>()(text));
        return found == places_.end() ? all_.size() : found->second;
    }

    std::vector<One> all_;
    std::size_t next_ = 0;
    std::size_t searched_ = 0;
    std::unordered_map<std::size_t, std::size_t> places_;  ///< by the hash of a text
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
