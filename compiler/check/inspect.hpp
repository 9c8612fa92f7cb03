// What can be said of a spec that may have errors, for editors.
// Takes: what check() takes. Gives: the model as far as it goes, and what each name means in it.
// Keeps true: the sink says the same as after check(); what has an error is marked broken, and is
// not to be looked at in the model.
#pragma once

#include <string>
#include <unordered_map>

#include "check/check.hpp"
#include "check/context/matrix.hpp"
#include "check/context/scope.hpp"

namespace etlc::check {

struct Inspected {
    struct Named {
        NameKind kind = NameKind::unreadable;
        Index index = 0;  ///< of the model's elements of that kind
        bool broken = false;
    };

    Model model;
    bool complete = false;  ///< what check() would give
    std::unordered_map<std::string, Named> names;
    /// The rate or period, "20" and "Hz"; empty: the spec has none that can be used.
    std::string step_number;
    std::string step_unit;

    /// Null where there is no such name, or what it names is broken.
    const Named* find(const std::string& name) const {
        const auto found = names.find(name);
        return found == names.end() || found->second.broken ? nullptr : &found->second;
    }
};

/// `known`: what files gave before; it then has those of this spec.
Inspected inspect(ast::Spec spec, const source::File& file, const Options& options,
                  KnownMatrices& known, diag::Sink& sink);

}  // namespace etlc::check
