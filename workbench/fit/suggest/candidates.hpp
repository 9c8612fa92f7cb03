// The distances that `etlc fit --suggest` tries for a predicate, with the declarations that they
// need, as lines of a spec. Names are new, and equal declarations are made once.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace etlc::fit {

/// Returns all words of a spec, which include its names.
std::set<std::string> words_of(std::string_view spec);

/// Declarations under names that start with a prefix.
class Declarations {
public:
    /// Avoids the names in `taken`, and adds its own to them; `taken` outlives this.
    Declarations(std::string prefix, std::set<std::string>& taken)
        : prefix_(std::move(prefix)), taken_(taken) {}

    /// Returns the name of `kind NAME = text;`, and declares it, with the role as its end, if it is
    /// new.
    std::string name(const std::string& kind, const std::string& role, const std::string& text);
    /// Returns a new name.
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

/// The parts of a candidate, in words of the language.
struct Candidate {
    std::string_view map;       ///< method of the projection; empty: none
    std::uint32_t r = 0;        ///< its rows
    bool discriminant = false;  ///< a discriminant of the projection, or of the point
    std::string_view targets;   ///< method of the targets
    std::uint32_t k = 0;        ///< their rows; 0: one
    std::string_view distance;  ///< "mahalanobis": by the fitted metric
    bool contrast =
        false;  ///< minus the same distance to the frames at which the predicate does not hold
};

/// Returns the candidates that fit a point of this dimension.
std::vector<Candidate> candidates(std::uint32_t dimension);

/// Describes a candidate: "min l2(pca 16(z), 8 medoids), contrast".
std::string described(const Candidate& candidate, const std::string& point);

/// Returns the distance of the candidate, from `point`, to frames at which `predicate` holds.
std::string expression(const Candidate& candidate, const std::string& point,
                       const std::string& predicate, Declarations& declarations);

}  // namespace etlc::fit
