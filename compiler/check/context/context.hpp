// What the steps of check share while they build the model.
// Takes: the tree. Gives: the model under construction, the names, and the one way to report.
// Keeps true: model.encoders, .inputs, .projections, .targets, .lets and .monitors and the named
// predicates begin with one element a declaration, in file order; an element that had an error is
// marked broken in `scope`.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <variant>
#include <vector>

#include "ast/ast.hpp"
#include "check/context/matrix.hpp"
#include "check/context/options.hpp"
#include "check/context/scope.hpp"
#include "check/model/model.hpp"
#include "data/files/file.hpp"
#include "diag/diag.hpp"
#include "embedded/embedded.hpp"
#include "fitted/fitted.hpp"

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
    /// `is_missing`: a file or a part of it is not there, which --check allows; nothing is then
    /// built on it.
    diag::Diagnostic& report_data(diag::Diagnostic found, bool is_missing) {
        found.is_allowed = is_missing && options.allow_missing;
        lacks_data = lacks_data || found.is_allowed;
        return sink.report(std::move(found));
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
    using enum NameKind;  // in the order of ast::Declaration; a rate and a truth declare none
    constexpr NameKind kKinds[] = {unreadable, constant,  encoder,    input, projection,
                                   target,     predicate, unreadable, let,   monitor};
    static_assert(std::size(kKinds) == std::variant_size_v<ast::Declaration>);
    const NameKind kind = kKinds[declaration.index()];
    std::visit(
        [&](const auto& d) {
            if constexpr (requires { d.names; })
                for (const ast::Name& name : d.names) visit(kind, name);
            else if constexpr (requires { d.name; })
                visit(kind, d.name);
        },
        declaration);
}

/// What `name` means; null, with a diagnostic at the first such use, where nothing declares it.
/// `wanted` is what would fit here, in words ("a predicate, a let or a bool input"), `kinds` the
/// kinds among which a near name is looked for.
const Reference* find(Context& context, const ast::Name& name, const std::vector<NameKind>& kinds,
                      std::string_view wanted);
/// The same, and an error where the name is of another kind than `kind`. kNone: reported, or the
/// declaration is broken.
Index resolve(Context& context, const ast::Name& name, NameKind kind);

/// An error at a word that is none of `words`: "'w' is no METHOD; expected WORDS".
void report_unknown_word(Context& context, diag::Code code, const ast::Name& word,
                         std::string_view why, const std::vector<std::string>& words);

/// Whether something made from the spec is still what the spec asks for; else an error with what
/// differs, and how to make it again.
bool is_up_to_date(Context& context, diag::Code code, Span span, std::string message,
                   const std::vector<std::string>& differences, std::string_view again);

/// Reads a file that etlc made; nothing, with a diagnostic that says what it is for, where it is
/// damaged.
template <class File>
std::optional<File> read_made(Context& context, const std::string& path,
                              diag::Result<File> (*read)(const std::string&), Span user,
                              std::string what_for) {
    auto file = read(path);
    if (file) {
        context.dependencies.insert(path);
        return std::move(*file);
    }
    std::error_code error;
    diag::Diagnostic found = data::in_file(file.failure(), path);
    found.is_allowed = context.options.allow_missing && !std::filesystem::exists(path, error);
    context.sink.report(std::move(found)).note(user, std::move(what_for));
    return std::nullopt;
}

/// The number for messages, with the name that stands for it: "limit = 0.5".
std::string shown(const ast::Number& number);

/// The number rounded once to float32; overflow and underflow are reported, with 1 in its place.
float number32(Context& context, const ast::Number& number);

// The steps of check, in the order in which check.cpp runs them. Each adds its part to the model
// and reports what it finds; none depends on another having succeeded, only on its having run.
void set_constants(Context& context, ast::Spec& spec);
void declare_names(Context& context);
void check_rate(Context& context);
void check_encoders(Context& context);
void check_inputs(Context& context);
void collect_encoded(Context& context);
void check_embeddings(Context& context);
void check_projections(Context& context);
void check_targets(Context& context);
void check_predicates(Context& context);
void check_lets(Context& context);
void check_truths(Context& context);
void check_fitted_frames(Context& context);
void check_fitted_entries(Context& context);
void check_monitors(Context& context);
void choose_telemetry(Context& context);
void check_thresholds(Context& context);
void set_robustness(Context& context);
void warn(Context& context);
void make_retargetable(Context& context);

}  // namespace etlc::check
