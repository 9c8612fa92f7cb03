// What the steps of check share while they build the model.
// Takes: the tree. Gives: the model under construction, the names, and the one way to report.
// Keeps true: model.encoders, .inputs, .projections, .targets, .lets and .monitors and the named
// predicates begin with one element a declaration, in file order; an element that had an error is
// marked broken in `scope`.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "ast/ast.hpp"
#include "check/context/matrix.hpp"
#include "check/context/options.hpp"
#include "check/context/scope.hpp"
#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "artifacts/embedded.hpp"
#include "artifacts/fitted.hpp"

namespace etlc::check {

/// Formulas that nest deeper, their lets written out, are refused, so that later stages may
/// recurse.
inline constexpr std::uint32_t kMaxDepth = 1000;

/// The length of one step as the spec gives it.
struct StepLength {
    const ast::Rate* rate = nullptr;  ///< none given, or none that can be used
    bool broken = false;              ///< one was given and had an error
};

struct Context {
    const ast::Spec& spec;
    const source::File& file;
    const Options& options;
    diag::Sink& sink;

    /// parse/ had errors: what is missing may stand in what it could not read.
    bool incomplete = false;
    /// A target is missing, and may be.
    bool lacks_data = false;
    Model model{};
    Scope scope{};
    StepLength step{};

    /// Those above 0 without a unit, by their places.
    std::map<std::uint32_t, const ast::Bound*> bare_bounds{};
    bool steps_on_purpose = false;  ///< some bound has the unit `steps`

    /// Parallel to model.formulas.
    std::vector<Span> operator_spans{};
    std::vector<std::uint32_t> depths{};

    /// Canonical text of what stands once in the model, to where it stands.
    std::unordered_map<std::string, Index> point_of_text{};
    std::unordered_map<std::string, Index> distance_of_text{};
    std::unordered_map<std::string, Index> predicate_of_text{};

    /// By target and point, the target with its rows in the space of the point.
    std::map<std::pair<Index, Index>, Index> projected_targets{};
    /// Parallel to model.fitted: which frames.
    std::vector<const ast::Formula*> fitted_where{};
    /// Nothing where it was not needed, or could not be read.
    std::optional<fitted::File> fitted_file{};
    bool fitted_is_read = false;
    /// Of the spec's encoders; nothing where there are none, or it could not be read.
    std::optional<embedded::File> embedded_file{};

    std::unordered_set<std::string> unknown_names{};
    std::unordered_set<std::string> used_constants{};
    /// Files read so far, by path and key; nothing for one that had an error.
    std::map<std::pair<std::string, std::string>, std::optional<Matrix>> matrices{};
    /// Of earlier checks; null: every file is read.
    KnownMatrices* known = nullptr;
    std::set<std::string> dependencies{};

    diag::Diagnostic& report(diag::Code code, Span span, std::string message) {
        return sink.report(code, span, std::move(message));
    }
};

/// Declarations of one alternative, in file order.
template <class T, class Visit>
void for_each_declaration(const ast::Spec& spec, Visit visit) {
    Index index = 0;
    for (const ast::Declaration& declaration : spec.declarations)
        if (const auto* found = std::get_if<T>(&declaration)) visit(*found, index++);
}

/// The names that a declaration declares, with the kind of each.
template <class Visit>
void for_each_name(const ast::Declaration& declaration, const Visit& visit) {
    if (const auto* constant = std::get_if<ast::Constant>(&declaration))
        visit(NameKind::constant, constant->name);
    if (const auto* encoder = std::get_if<ast::Encoder>(&declaration))
        visit(NameKind::encoder, encoder->name);
    if (const auto* input = std::get_if<ast::Input>(&declaration))
        for (const ast::Name& name : input->names) visit(NameKind::input, name);
    if (const auto* projection = std::get_if<ast::Projection>(&declaration))
        visit(NameKind::projection, projection->name);
    if (const auto* target = std::get_if<ast::Target>(&declaration))
        visit(NameKind::target, target->name);
    if (const auto* predicate = std::get_if<ast::Predicate>(&declaration))
        visit(NameKind::predicate, predicate->name);
    if (const auto* let = std::get_if<ast::Let>(&declaration)) visit(NameKind::let, let->name);
    if (const auto* monitor = std::get_if<ast::Monitor>(&declaration))
        visit(NameKind::monitor, monitor->name);
}

/// What `name` means; null, with a diagnostic at the first such use, where nothing declares it.
/// `wanted` is what would fit here, in words ("a predicate, a let or a bool input"), `kinds` the
/// kinds among which a near name is looked for.
const Reference* find(Context& context, const ast::Name& name, const std::vector<NameKind>& kinds,
                      std::string_view wanted);
/// The same, and an error where the name is of another kind than `kind`. kNone: reported, or the
/// declaration is broken.
Index resolve(Context& context, const ast::Name& name, NameKind kind);

/// The number for messages, with the name that stands for it: "limit = 0.5".
std::string shown(const ast::Number& number);

/// The number rounded once to float32; overflow and underflow are reported, with 1 in its place.
float number32(Context& context, const ast::Number& number);

}  // namespace etlc::check
