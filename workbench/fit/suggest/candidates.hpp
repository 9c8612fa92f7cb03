// What `etlc fit --suggest` tries for a predicate.
// Takes: the point that the predicate measures. Gives: per candidate a distance and the
// declarations that it needs, as lines of a spec. Keeps true: names are new; the same declaration
// is made once.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace etlc::fit {

/// The names in a spec, and whatever else looks like one.
std::set<std::string> words_of(std::string_view spec);

/// Lines that declare something, under names that start with a prefix.
class Declarations {
public:
    /// Names are none of `taken`, and are there from now on. It outlives this.
    Declarations(std::string prefix, std::set<std::string>& taken)
        : prefix_(std::move(prefix)), taken_(taken) {}

    /// The name of `kind NAME = text;`, which ends in the role where none has that yet.
    std::string name(const std::string& kind, const std::string& role, const std::string& text);
    /// A name that is none of those taken.
    std::string unused(const std::string& wanted);

    const std::vector<std::string>& lines() const { return lines_; }

private:
    struct Declared {
        std::string kind, text, name;
    };

    std::string prefix_;
    std::set<std::string>& taken_;
    std::vector<Declared> declared_;
    std::vector<std::string> lines_;
};

/// What a candidate is made of; the words are those of the language.
struct Candidate {
    std::string_view map;       ///< method of the projection; empty: none
    std::uint32_t r = 0;        ///< its rows
    bool discriminant = false;  ///< behind it, or of the point itself
    std::string_view targets;   ///< method of the targets
    std::uint32_t k = 0;        ///< their rows; 0: one
    std::string_view distance;  ///< "mahalanobis": by the fitted metric
    bool contrast = false;  ///< less the same to the frames at which the predicate does not hold
};

/// Those that a point of this dimension allows.
std::vector<Candidate> candidates(std::uint32_t dimension);

/// "min l2(pca 16(z), 8 medoids), contrast"
std::string described(const Candidate& candidate, const std::string& point);

/// The distance of the candidate, from `point`, to frames at which `predicate` holds.
std::string expression(const Candidate& candidate, const std::string& point,
                       const std::string& predicate, Declarations& declarations);

}  // namespace etlc::fit
