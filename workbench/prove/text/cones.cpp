#include "prove/text/cones.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <regex>
#include <utility>

#include "prove/text/code.hpp"

namespace etlc::prove {
namespace {

using Names = Cones::Names;
using code::closing;
using code::Found;
using code::name_at;
using code::names_in;
using code::skip_space;

Names set_of(const std::vector<Found>& found) {
    Names names;
    for (const Found& one : found) names.insert(one.name);
    return names;
}

bool is_member(std::string_view name) {
    return name.ends_with("_") || name.starts_with("answers_.");
}

constexpr std::string_view kLazy = "const etlmon::Lazy ";

/// Whether a condition is a name, or "a || b".
bool is_choice(std::string_view text) {
    static const std::regex kChoice(R"(^\s*\w+(\s*\|\|\s*\w+)*\s*$)");
    return std::regex_match(text.begin(), text.end(), kChoice);
}

}  // namespace

/// Reads the body of a function into statements.
class Cones::Reader {
    /// The conditions around a statement: what they name, and those that are "a || b".
    struct Conditions {
        Names named;
        std::vector<Names> one_of;
        bool empty() const { return named.empty() && one_of.empty(); }
    };

public:
    Reader(Cones& cones, const Names& atoms) : cones_(cones), atoms_(atoms) {}

    Statements body(std::string_view text) {
        statements_.clear();
        skips_ = false;
        read(text, {});
        const auto writes = [](const Statement& one) {
            return std::any_of(one.written.begin(), one.written.end(), is_member);
        };
        if (skips_ && std::any_of(statements_.begin(), statements_.end(), writes))
            throw Unreadable{"a 'return' before the end"};
        return std::move(statements_);
    }

private:
    Cones& cones_;
    const Names& atoms_;
    Statements statements_;
    std::uint32_t lazies_ = 0;
    bool skips_ = false;     ///< a statement may end the function early
    bool measures_ = false;  ///< in the function of an atom
    bool counts_ = true;     ///< every lazy value so far is made at every step

    void read(std::string_view text, const Conditions& conditions) {
        for (std::size_t at = skip_space(text, 0); at < text.size(); at = skip_space(text, at)) {
            const std::string_view word = name_at(text, at);
            if (word == "if" || word == "for") {
                at = read_block(text, at + word.size(), conditions);
            } else if (word == "ETLMON_UNROLL") {
                at += word.size();
            } else if (text[at] == '{') {
                const std::size_t end = closing(text, at);
                read(text.substr(at + 1, end - at - 1), conditions);
                at = end + 1;
            } else {
                const std::size_t end = end_of_statement(text, at);
                read_simple(text.substr(at, end - at), conditions);
                at = end + 1;
            }
        }
    }

    /// Reads what follows "if" or "for", with every "else". Returns the place after it.
    std::size_t read_block(std::string_view text, std::size_t at, Conditions conditions) {
        const std::vector<Names> around = conditions.one_of;
        for (bool is_first = true;; is_first = false) {
            at = skip_space(text, at);
            if (at < text.size() && text[at] == '(') {
                const std::size_t end = closing(text, at);
                const std::string_view head = text.substr(at + 1, end - at - 1);
                read_simple(head, conditions);
                if (is_first && is_choice(head))
                    conditions.one_of.push_back(set_of(names_in(head)));
                else
                    conditions.named.merge(set_of(names_in(head)));
                at = skip_space(text, end + 1);
            }
            const bool is_block = at < text.size() && text[at] == '{';
            const std::size_t end = is_block ? closing(text, at) : end_of_statement(text, at);
            const std::string_view inside =
                is_block ? text.substr(at + 1, end - at - 1) : text.substr(at, end - at);
            if (inside.find(kLazy) != std::string_view::npos) counts_ = false;
            read(inside, conditions);
            at = skip_space(text, end + 1);
            if (name_at(text, at) != "else") return end + 1;
            at = skip_space(text, at + 4);
            for (const Names& names : std::exchange(conditions.one_of, around))
                conditions.named.insert(names.begin(), names.end());
            if (name_at(text, at) == "if") at += 2;
        }
    }

    static std::size_t end_of_statement(std::string_view text, std::size_t at) {
        for (; at < text.size() && text[at] != ';'; ++at)
            if (text[at] == '(' || text[at] == '{' || text[at] == '[') at = closing(text, at);
        return at;
    }

    void read_simple(std::string_view text, const Conditions& conditions) {
        static const Names kJumps = {"while", "do",  "switch", "case", "break",
                                     "goto",  "try", "throw",  "asm",  "continue"};
        const std::string first(name_at(text, 0));
        const bool may_skip = first == "return" && !conditions.empty();
        skips_ = skips_ || may_skip;
        if (!measures_ && kJumps.contains(first))
            throw Unreadable{fmt::format("'{}' in a step", first)};
        if (text.starts_with(kLazy)) return read_lazy(text, conditions);
        if (text == "answers_ = Verdicts()") return;  // each verdict becomes a constant
        add(text, conditions, {});
    }

    void add(std::string_view text, const Conditions& conditions, Names written) {
        const std::vector<Found> found = names_in(text);
        Statement statement{std::move(written), set_of(found), conditions.one_of};
        // Another name for what follows, or for one of two things.
        const std::size_t choice = text.find('?') + 1;
        if (code::makes_reference(text))
            statement.written.merge(set_of(names_in(text.substr(choice))));
        for (const Found& one : found)
            if (code::is_written(text, one)) statement.written.insert(one.name);
        statement.named.insert(conditions.named.begin(), conditions.named.end());
        statements_.push_back(std::move(statement));
    }

    /// Reads "const etlmon::Lazy NAME([&]() noexcept { ... })".
    void read_lazy(std::string_view text, const Conditions& conditions) {
        const std::string name(name_at(text, skip_space(text, kLazy.size())));
        const std::size_t open = text.find('{');
        if (name.empty() || open == std::string_view::npos)
            throw Unreadable{"a lazy value without a function"};
        if (conditions.empty() && counts_) cones_.lazies_[name] = lazies_;
        ++lazies_;
        const std::string_view inside = text.substr(open + 1, closing(text, open) - open - 1);
        if (!atoms_.contains(name)) return add(inside, conditions, {name});
        Statements before = std::move(statements_);
        statements_.clear();
        const bool skips = skips_;
        measures_ = true;
        read(inside, {});
        measures_ = false;
        skips_ = skips;
        for (const Statement& statement : statements_)
            cones_.measured_.insert(statement.written.begin(), statement.written.end());
        statements_ = std::move(before);
    }
};

Cones::Cones(std::string_view header, const Names& atoms) {
    const std::string text = code::without_comments(header);
    const std::size_t begin = text.find("\nclass Monitor {");
    constexpr std::string_view kAdvance = " Monitor::advance(const Inputs& in) noexcept {";
    const std::size_t advance = text.find(kAdvance);
    if (begin == std::string::npos || advance == std::string::npos)
        throw Unreadable{"no class 'Monitor' with a function 'advance'"};
    Reader reader(*this, atoms);
    const auto body = [&](std::size_t open) {
        return std::string_view(text).substr(open + 1, closing(text, open) - open - 1);
    };
    functions_["advance"] = reader.body(body(advance + kAdvance.size() - 1));
    const std::size_t open = text.find('{', begin);
    const std::string_view inside = body(open);
    static const std::regex kFunction(R"((\w+)\([^()]*\)\s*(const\s+)?noexcept\s*\{)");
    using Iterator = std::regex_iterator<std::string_view::const_iterator>;
    for (Iterator at(inside.begin(), inside.end(), kFunction), end; at != end; ++at) {
        const auto last = static_cast<std::size_t>(at->position() + at->length()) - 1;
        functions_[(*at)[1].str()] = Reader(*this, {}).body(body(open + 1 + last));
    }
    for (auto& [caller, of] : functions_)
        for (Statement& statement : of)
            for (const auto& [name, statements] : functions_)
                if (statement.named.erase(name) > 0) statement.called.insert(name);
    while (join_calls(true)) {
    }
    while (join_calls(false)) {
    }
}

bool Cones::join_calls(bool conditions) {
    bool changed = false;
    for (auto& [name, statements] : functions_)
        for (auto& [caller, of] : functions_)
            for (Statement& call : of) {
                // What advance() does is known by its statements.
                if (name == "advance" || !call.called.contains(name)) continue;
                for (Statement& inside : statements) {
                    if (conditions && inside.written.empty()) continue;
                    if (conditions)
                        for (const Names& names : call.one_of)
                            inside.named.insert(names.begin(), names.end());
                    const Names& from = conditions ? call.named : inside.named;
                    Names& to = conditions ? inside.named : call.named;
                    const std::size_t before = to.size();
                    to.insert(from.begin(), from.end());
                    changed = changed || to.size() != before;
                }
            }
    return changed;
}

bool Cones::depends(const Statement& statement, const Names& names) {
    return std::any_of(
        statement.written.begin(), statement.written.end(),
        [&](const auto& written) { return names.contains(written) || written == "answers_"; });
}

Names Cones::of(const std::string& verdict, const std::string& open) const {
    Names names{verdict};
    for (std::size_t before = 0; before != names.size();) {
        before = names.size();
        for (const auto& [function, statements] : functions_)
            for (const Statement& statement : statements) {
                if (!depends(statement, names)) continue;
                names.insert(statement.named.begin(), statement.named.end());
                for (const Names& one_of : statement.one_of)  // is true while this is open
                    if (!one_of.contains(open) || one_of.size() == 1)
                        names.insert(one_of.begin(), one_of.end());
            }
    }
    for (const std::string& one : names)
        if (measured_.contains(one))
            throw Unreadable{fmt::format("a verdict that depends on '{}', which is measured", one)};
    return names;
}

bool Cones::freezes(const std::string& verdict, const std::string& open) const {
    for (const Statement& statement : functions_.at("advance")) {
        if (depends(statement, {verdict}) &&
            std::find(statement.one_of.begin(), statement.one_of.end(), Names{open}) ==
                statement.one_of.end())
            return false;
        const Names itself{verdict, open, "finishes_"};
        if (depends(statement, {open}) &&
            (!statement.one_of.empty() || !statement.called.empty() ||
             !std::includes(itself.begin(), itself.end(), statement.named.begin(),
                            statement.named.end())))
            return false;
    }
    return !open.empty();
}

bool Cones::writes(const std::string& function, const Names& names) const {
    Names called{function};
    for (std::size_t before = 0; before != called.size();) {
        before = called.size();
        for (const auto& [name, statements] : functions_)
            for (const Statement& statement : statements)
                if (called.contains(name))
                    called.insert(statement.called.begin(), statement.called.end());
    }
    for (const auto& [name, statements] : functions_)
        for (const Statement& statement : statements)
            if (called.contains(name) &&
                std::any_of(statement.written.begin(), statement.written.end(),
                            [&](const auto& written) { return names.contains(written); }))
                return true;
    return !functions_.contains(function);
}

std::uint32_t Cones::lazy(const std::string& atom) const {
    const auto found = lazies_.find(atom);
    if (found == lazies_.end())
        throw Unreadable{fmt::format("no lazy value '{}' at every step", atom)};
    return found->second;
}

}  // namespace etlc::prove
