// Syntax tree to typed spec.
// Takes: the tree, and the files it loads (paths relative to the spec). Gives: the model, or
// nothing where there was an error. Keeps true: all errors are reported in one go, each cause once;
// a broken declaration hides no other and causes no cascade.
#pragma once

#include <optional>
#include <string>
#include <unordered_map>

#include "ast/ast.hpp"
#include "check/context/matrix.hpp"
#include "check/context/options.hpp"
#include "check/context/scope.hpp"
#include "check/model/model.hpp"
#include "diag/diag.hpp"

namespace etlc::check {

/// Nothing where there was an error, or where a target is allowed to be missing and is.
std::optional<Model> check(ast::Spec spec, const source::File& file, const Options& options,
                           diag::Sink& sink);

/// What `etlc embed` needs: of the model the encoders, the inputs, what the targets encode, and the
/// rate. Nothing where there was an error in these.
std::optional<Model> check_encoded(ast::Spec spec, const source::File& file, const Options& options,
                                   diag::Sink& sink);

/// What there is of a spec that may have errors, for editors: the model as far as it goes, and what
/// each name means in it. What has an error is marked broken, and is not to be looked at in the
/// model.
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
