// Random chains from a world to a guarantee, for the campaign in test_chains.cpp.
// Takes: random numbers. Gives: a world to draw episodes from, a spec with something to calibrate
// on them, and changes of the spec. Keeps true: episodes of a world are drawn independently in the
// same way, so they are exchangeable.
#pragma once

#include <string>
#include <vector>

#include "random.hpp"

namespace etlc::tests {

/// The source of episodes.
struct World {
    bool frames_alike = false;  ///< whether frames are drawn one by one
    double missing = 0;         ///< P(a sample is missing)
    double missing_truth = 0;   ///< of y
    double noise = 0;
    bool arrays = false;  ///< whether labels are recorded, by a rule that no spec states
};

/// Returns an episode as the text of a .csv file, with labels if `with_array`.
std::string episode_of(const World& world, bool with_array, Random& random);

enum class Method { f1, conformal, class_conditional, adaptive, whole, whole_of_f1 };

struct Chain {
    World world;
    Method method = Method::conformal;
    std::string spec;
    bool has_fitted = false;
};

Chain random_chain(Random& random);

/// Replaces the first `from` in a spec by `to`; if both are empty, nothing changes.
struct Edit {
    std::string from, to;
    std::string name() const { return from.empty() ? "none" : from + " -> " + to; }
};

/// Returns an edit that applies; sometimes none.
Edit random_edit(const std::string& spec, Random& random);

}  // namespace etlc::tests
