// Checks a syntax tree and returns the typed model. All errors are reported in one run, each cause
// once; a broken declaration hides no other errors and causes no cascade.
#pragma once

#include <optional>
#include <string>
#include <unordered_map>

#include "ast/ast.hpp"
#include "check/context/context.hpp"
#include "check/context/options.hpp"
#include "check/context/scope.hpp"
#include "check/model/model.hpp"
#include "diag/diag.hpp"

namespace etlc::check {

/// Returns nothing after an error, or where a target is missing and --check allows it.
std::optional<Model> check(ast::Spec spec, const source::File& file, const Options& options,
                           diag::Sink& sink);

/// Checks what `etlc embed` needs: encoders, inputs, the images and videos of targets, and the
/// rate. Returns nothing after an error in these.
std::optional<Model> check_encoded(ast::Spec spec, const source::File& file, const Options& options,
                                   diag::Sink& sink);

/// The result for a spec that may have errors, for editors: the model as far as it could be built,
/// and the meaning of each name. Elements with errors are marked broken; their model elements are
/// not valid.
struct Inspected {
    struct Named {
        NameKind kind = NameKind::unreadable;
        Index index = 0;  ///< in the model's elements of that kind
        bool broken = false;
    };

    Model model;
    bool complete = false;  ///< whether check() would return a model
    std::unordered_map<std::string, Named> names;
    /// The rate or period, "20" and "Hz"; empty if the spec has no usable one.
    std::string step_number;
    std::string step_unit;

    /// Returns null if the name is unknown or its declaration is broken.
    const Named* find(const std::string& name) const {
        const auto found = names.find(name);
        return found == names.end() || found->second.broken ? nullptr : &found->second;
    }
};

/// `cache` has the contents of files between calls; and afterwards those of this spec.
Inspected inspect(ast::Spec spec, const source::File& file, const Options& options,
                  MatrixCache& cache, diag::Sink& sink);

}  // namespace etlc::check
