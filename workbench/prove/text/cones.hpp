// What the verdict of a monitor depends on, by the text of its class. Takes: a header with
// --values boolean, as etlc writes it. Gives: for each monitor the members of the state and the
// atoms that its verdict depends on, at any later step. Keeps true: too much may be named, never
// too little; a text that is not understood is refused.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace etlc::prove {

/// Thrown where the text of a class is not as etlc writes it.
struct Unreadable {
    std::string what;
};

class Cones {
public:
    using Names = std::set<std::string>;

    /// `atoms`: the names of its lazy values that are predicates and bool inputs. Throws
    /// Unreadable.
    Cones(std::string_view header, const Names& atoms);

    /// Returns the names that a name of the class depends on, with itself. Throws Unreadable.
    Names of(const std::string& name) const { return of(name, ""); }
    /// Returns those that a verdict depends on while it is open, if it is not written once it is
    /// not. `open`: the name of "it is open"; empty: this verdict has none. Throws Unreadable.
    Names of(const std::string& verdict, const std::string& open) const;
    /// Whether a verdict is written only while it is open, and this depends on nothing else.
    bool freezes(const std::string& verdict, const std::string& open) const;
    /// Whether a function of the class writes one of these names.
    bool writes(const std::string& function, const Names& names) const;
    /// Returns the place of an atom among the lazy values of a step. Throws Unreadable.
    std::uint32_t lazy(const std::string& atom) const;

private:
    /// Each name that is written depends on all that are named, and on the conditions around it.
    struct Statement {
        Names written;
        Names named;
        std::vector<Names> one_of{};  ///< conditions "a || b"
        Names called{};               ///< functions of the class
    };
    static bool depends(const Statement& statement, const Names& names);
    using Statements = std::vector<Statement>;
    class Reader;

    /// A function writes under the conditions of its calls, and a call gives a value that depends
    /// on all that the function names. Returns whether that adds something.
    bool join_calls(bool conditions);

    std::map<std::string, Statements, std::less<>> functions_;
    Names measured_;  ///< what only atoms write
    std::map<std::string, std::uint32_t> lazies_;
};

}  // namespace etlc::prove
