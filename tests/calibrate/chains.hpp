// Random chains from a world to a promise, for the campaign over them.
// Takes: random numbers. Gives: a world that episodes are drawn from, a spec with something that is
// calibrated on them, and what may become of the spec afterwards. Keeps true: episodes of a world
// are drawn alike, so they are exchangeable.
#pragma once

#include <string>
#include <vector>

#include "random.hpp"

namespace etlc::tests {

/// Where episodes come from.
struct World {
    bool frames_alike = false;  ///< frames are drawn one by one
    double missing = 0;         ///< of each sample
    double missing_truth = 0;   ///< of y
    double noise = 0;
    bool arrays = false;  ///< labels are recorded, by a rule that no spec states
};

/// As the text of a .csv file. `with_array`: with labels.
std::string episode_of(const World& world, bool with_array, Random& random);

enum class Method { f1, conformal, class_conditional, adaptive, whole, whole_of_f1 };

struct Chain {
    World world;
    Method method = Method::conformal;
    std::string spec;
    bool has_fitted = false;
};

Chain random_chain(Random& random);

/// The first `from` in a spec becomes `to`; where both are empty, nothing does.
struct Edit {
    std::string from, to;
    std::string name() const { return from.empty() ? "none" : from + " -> " + to; }
};

/// One that applies; or none, now and then.
Edit random_edit(const std::string& spec, Random& random);

}  // namespace etlc::tests
