// State shared by the steps of check while they build the model. model.encoders, .inputs,
// .projections, .targets, .lets, .monitors and the named predicates begin with one element for each
// declaration, in file order; elements with errors are marked broken in `scope`.
#pragma once

#include <cstdint>
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

#include "artifacts/embedded.hpp"
#include "artifacts/fitted.hpp"
#include "ast/ast.hpp"
#include "check/context/options.hpp"
#include "check/context/scope.hpp"
#include "check/model/model.hpp"
#include "data/files/file.hpp"
#include "diag/diag.hpp"

namespace etlc::check {

// A matrix of float32 that a spec loads or contains, and a cache of loaded ones.

struct Matrix {
    std::uint32_t rows = 0;
    std::uint32_t columns = 0;
    /// A one-dimensional array in a file, or a literal [1, 2, 3]; rows is then 1.
    bool one_dimensional = false;
    std::vector<float> values;  ///< row-major
    std::string origin;         ///< "targets/goal_a.npy", "file.npz:key" or "literal"
    std::string path;  ///< of the file, relative to the working directory; empty for a literal
    std::string hash;
    std::vector<EncodedRows> encoded;  ///< rows made from images
};

/// A loaded matrix, by path and key, for callers that check a spec repeatedly. It is valid while
/// the file has the same time and size.
struct CachedMatrix {
    std::filesystem::file_time_type time;
    std::uintmax_t size = 0;
    Matrix matrix;
};
using MatrixCache = std::map<std::pair<std::string, std::string>, CachedMatrix>;

/// Limit on the depth of formulas with their lets written out, so that later stages may recurse.
inline constexpr std::uint32_t kMaxDepth = 1000;

/// The length of one step as given in the spec.
struct StepLength {
    const ast::Rate* rate = nullptr;  ///< null if missing or unusable
    bool broken = false;              ///< given, but with an error
};

struct Context {
    const ast::Spec& spec;
    const source::File& file;
    const Options& options;
    diag::Sink& sink;

    /// parse/ had errors, so missing declarations may be among what it could not read.
    bool incomplete = false;
    /// A target is missing and --check allows it.
    bool lacks_data = false;
    Model model{};
    Scope scope{};
    StepLength step{};

    /// Bounds above 0 without a unit, by place.
    std::map<std::uint32_t, const ast::Bound*> bare_bounds{};
    bool steps_on_purpose = false;  ///< some bound has the unit `steps`

    /// Parallel to model.formulas.
    std::vector<Span> operator_spans{};
    std::vector<std::uint32_t> depths{};

    /// Index of each point, distance, past number and predicate by canonical text, since the model
    /// has equal ones once.
    std::unordered_map<std::string, Index> point_of_text{};
    std::unordered_map<std::string, Index> distance_of_text{};
    std::unordered_map<std::string, Index> past_of_text{};
    std::unordered_map<std::string, Index> predicate_of_text{};

    /// The duration of the monitor whose formula is being checked; null elsewhere.
    std::optional<Duration>* duration = nullptr;

    bool is_in_truth = false;  ///< the formula of a truth is being checked

    /// The point that a target is declared or fitted `of`, without its delay, for those that have
    /// one.
    std::map<Index, Index> point_of_target{};
    /// The encoder that made rows of a target, for those that it is known of.
    std::map<Index, Index> encoder_of_target{};
    /// The projected target for each target and point.
    std::map<std::pair<Index, Index>, Index> projected_targets{};
    /// The `where` of each element of model.fitted.
    std::vector<const ast::Formula*> fitted_where{};
    /// Empty if not needed or not readable.
    std::optional<fitted::File> fitted_file{};
    bool fitted_is_read = false;
    /// Empty if the spec has no encoders or the file is not readable.
    std::optional<embedded::File> embedded_file{};

    std::unordered_set<std::string> unknown_names{};
    std::unordered_set<std::string> used_constants{};
    /// Files read so far, by path and key; empty after an error.
    std::map<std::pair<std::string, std::string>, std::optional<Matrix>> matrices{};
    /// Contents from earlier checks; null: every file is read.
    MatrixCache* cache = nullptr;
    std::set<std::string> dependencies{};

    diag::Diagnostic& report(diag::Code code, Span span, std::string message) {
        return sink.report(code, span, std::move(message));
    }
    /// Report an error, and return what checks return after one: false, or no value.
    bool refuse(diag::Code code, Span span, std::string message) {
        report(code, span, std::move(message));
        return false;
    }
    std::nullopt_t no_value(diag::Code code, Span span, std::string message) {
        report(code, span, std::move(message));
        return std::nullopt;
    }
    /// Reports an error in a data file. If the file or a part of it is missing, --check turns the
    /// error into a note, and nothing that needs the data is checked.
    diag::Diagnostic& report_data(diag::Diagnostic found, bool is_missing = true) {
        found.is_allowed = is_missing && options.allow_missing;
        lacks_data = lacks_data || found.is_allowed;
        return sink.report(std::move(found));
    }
};

/// Visits the declarations of one kind, in file order.
template <class T, class Visit>
void for_each_declaration(const ast::Spec& spec, Visit visit) {
    Index index = 0;
    for (const ast::Declaration& declaration : spec.declarations)
        if (const auto* found = std::get_if<T>(&declaration)) visit(*found, index++);
}

/// Visits the names in a declaration with their kinds.
template <class Visit>
void for_each_name(const ast::Declaration& declaration, const Visit& visit) {
    using enum NameKind;  // in the order of ast::Declaration; a rate and a truth declare no names
    constexpr NameKind kKinds[] = {unreadable, constant,   encoder, input,   projection, target,
                                   predicate,  unreadable, let,     monitor, drift};
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

/// Returns the meaning of a name; null, with an error at the first use, if it is not declared.
/// `wanted` describes what is accepted ("a predicate, a let or a bool input"); similar names are
/// searched among `kinds`.
const Reference* find(Context& context, const ast::Name& name,
                      std::initializer_list<NameKind> kinds, std::string_view wanted);
/// Returns the index of a name of one kind; kNone after an error or if its declaration is broken.
Index resolve(Context& context, const ast::Name& name, NameKind kind);

/// Reports a word that is none of `words`: "'WORD' WHY; expected WORDS".
void report_unknown_word(Context& context, diag::Code code, const ast::Name& word,
                         std::string_view why, const std::vector<std::string>& words);

/// Whether something made from the spec is still what the spec asks for. Otherwise reports the
/// differences and how to make it again.
bool is_up_to_date(Context& context, diag::Code code, Span span, std::string message,
                   const std::vector<std::string>& differences, std::string_view again);

/// Reads a file that etlc has written. Returns nothing, with an error that mentions `what_for`, if
/// it is damaged.
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

/// Returns the number for messages, with the name of its constant: "limit = 0.5".
std::string shown(const ast::Number& number);

/// Rounds a number once to float32; returns 1 after reporting overflow or underflow.
float number32(Context& context, const ast::Number& number);

// The steps of check, in the order in which check.cpp runs them. Each adds its part to the model
// and reports errors; a step needs earlier ones to have run, not to have succeeded.
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
void check_drifts(Context& context);
void choose_telemetry(Context& context);
void check_thresholds(Context& context);
void set_robustness(Context& context);
void warn(Context& context);
void make_retargetable(Context& context);

}  // namespace etlc::check
