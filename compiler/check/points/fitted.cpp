#include "check/points/points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "check/context/context.hpp"
#include "check/guarantees/provenance.hpp"
#include "check/matrices/matrices.hpp"
#include "check/numbers/decimal.hpp"

namespace etlc::check {

namespace {

using diag::Code;
using Slot = Fitted::Slot;

/// The result of a method, and its arguments besides `of` and `where`.
struct Method {
    std::string_view word;
    FittedMethod method;
    Slot slot;
    std::string_view count;  ///< k for rows of a target, r for those of a projection; or empty
    bool away = false;       ///< accepts `away`
};

constexpr std::array kMethods = std::to_array<Method>({
    {"mean", FittedMethod::mean, Slot::target, ""},
    {"medoids", FittedMethod::medoids, Slot::target, "k", true},
    {"kmeans", FittedMethod::kmeans, Slot::target, "k", true},
    {"pca", FittedMethod::pca, Slot::projection, "r"},
    {"whitened_pca", FittedMethod::whitened_pca, Slot::projection, "r"},
    {"discriminant", FittedMethod::discriminant, Slot::projection, "r"},
    {"logpzo", FittedMethod::logpzo, Slot::projection, ""},
    {"discriminant", FittedMethod::discriminant, Slot::metric, ""},
});

constexpr std::uint64_t kMaxRows = 1U << 20U;

std::string_view word(Slot slot) {
    switch (slot) {
        case Slot::target: return "a target";
        case Slot::projection: return "a projection";
        case Slot::metric: break;
    }
    return "the weights of mahalanobis";
}

const Method* find_method(Context& c, const ast::Name& name, Slot slot) {
    std::vector<std::string> words;
    for (const Method& method : kMethods) {
        if (method.word == name.text && method.slot == slot) return &method;
        if (method.slot == slot) words.emplace_back(method.word);
    }
    report_unknown_word(c, Code::unknown_fitting, name, fmt::format("does not fit {}", word(slot)),
                        words);
    return nullptr;
}

/// Returns the form of the method.
std::string form(const Method& method) {
    return fmt::format("fitted({}{}, of = POINT, where = FORMULA)", method.word,
                       method.count.empty() ? "" : fmt::format(", {} = 8", method.count));
}

class FittedCheck {
public:
    FittedCheck(Context& context, const ast::Fitted& written, const Method& method)
        : c_(context), written_(written), method_(method) {}

    /// Returns the element without name and slot; nothing after an error.
    std::optional<Fitted> run() {
        const std::size_t errors = c_.sink.errors();
        for (const ast::Fitted::Argument& argument : written_.arguments) take(argument);
        if (c_.sink.errors() == errors) require_all();
        if (c_.sink.errors() > errors || fitted_.point == kNone) return std::nullopt;
        fitted_.method = method_.method;
        fitted_.slot = method_.slot;
        fitted_.span = written_.span;
        set_shape();
        if (c_.sink.errors() > errors) return std::nullopt;
        fitted_.declaration = canonical_text();
        return std::move(fitted_);
    }

    const ast::Formula* where() const { return where_; }

private:
    void take(const ast::Fitted::Argument& argument) {
        const std::string& key = argument.key.text;
        const auto* number = std::get_if<ast::Number>(&argument.value);
        const bool takes = number == nullptr || (key == method_.count && !key.empty()) ||
                           (key == "away" && method_.away);
        if (!takes) {
            c_.report(Code::fitting_argument, argument.key.span,
                      fmt::format("{} has no argument '{}'; expected {}", method_.word, key,
                                  form(method_)));
            return;
        }
        if (!given_.insert(key).second) {
            c_.report(Code::fitting_argument, argument.key.span,
                      fmt::format("{} is given twice", key));
            return;
        }
        if (const auto* point = std::get_if<ast::Point>(&argument.value)) {
            fitted_.point = check_point(c_, *point);
            if (fitted_.point != kNone && !is_of_recorded(fitted_.point)) fitted_.point = kNone;
        } else if (number == nullptr) {
            where_ = std::get<ast::FormulaPtr>(argument.value).get();
        } else if (key == "away") {
            fitted_.away = whole(key, *number, 0, kMaxBound);
        } else {
            count_ = number;
        }
    }

    /// Recorded samples are fitted, and projected after that: a projection stands outside.
    bool is_of_recorded(Index point) {
        Index at = point;
        while (c_.model.points[at].is_projected()) at = c_.model.points[at].inner;
        if (is_recorded(c_.model, at)) return true;
        return c_.refuse(Code::fitting_argument, written_.span,
                         fmt::format("{} is fitted to what a step computes; expected projections "
                                     "outside, as in P(z@2) for P(z)@2, or P([z, z@2])",
                                     c_.model.points[point].text));
    }

    void require_all() {
        for (const std::string_view needed :
             {std::string_view("of"), std::string_view("where"), method_.count}) {
            if (needed.empty() || given_.contains(std::string(needed))) continue;
            c_.report(
                Code::fitting_argument, written_.span,
                fmt::format("{} needs '{}'; expected {}", method_.word, needed, form(method_)));
            return;
        }
    }

    std::uint32_t whole(std::string_view key, const ast::Number& number, std::uint64_t least,
                        std::uint64_t most) {
        const auto value = Decimal::parse(number.text).whole(most);
        if (value && *value >= least) return static_cast<std::uint32_t>(*value);
        c_.report(Code::fitting_argument, number.span,
                  fmt::format("{} = {}; expected a whole number from {} to {}", key, shown(number),
                              least, most));
        return 1;
    }

    void set_shape() {
        fitted_.columns = c_.model.points[fitted_.point].dimension;
        const std::uint64_t most = fitted_.method == FittedMethod::discriminant ? 1
                                   : method_.slot == Slot::target               ? kMaxRows
                                                                                : fitted_.columns;
        if (count_ != nullptr)
            fitted_.rows = whole(method_.count, *count_, 1, most);
        else
            fitted_.rows = method_.slot == Slot::target ? 1 : fitted_.columns;
    }

    std::string canonical_text() const {
        const std::string count =
            method_.count.empty() ? "" : fmt::format(", {} = {}", method_.count, fitted_.rows);
        const std::string away = fitted_.away == 0 ? "" : fmt::format(", away = {}", fitted_.away);
        return fmt::format("fitted({}{}{}, of = {}, where = {})", method_.word, count, away,
                           c_.model.points[fitted_.point].text, ast::print(*where_));
    }

    Context& c_;
    const ast::Fitted& written_;
    const Method& method_;
    Fitted fitted_;
    const ast::Formula* where_ = nullptr;
    const ast::Number* count_ = nullptr;
    std::set<std::string> given_;
};

// ---- the file of fitted values
// -------------------------------------------------------------------

constexpr std::string_view kFitAgain = "fit again with 'etlc fit'";

std::optional<fitted::File> read_file(Context& c, const Fitted& first) {
    if (c.options.fitted != nullptr) return *c.options.fitted;
    const std::string path =
        c.options.fitted_path.empty() ? fitted::default_path(c.file.path()) : c.options.fitted_path;
    if (exists(path))
        return read_made(c, path, fitted::read, first.span,
                         fmt::format("'{}' is fitted", first.name));
    c.report_data({Code::fitted_missing,
                   fmt::format("'{}' is fitted, but there is no file {}", first.name, path),
                   first.span})
        .note("'etlc fit' makes one from labelled demonstrations; --fitted selects another");
    return std::nullopt;
}

bool is_current(Context& c, const Fitted& fitted, const std::vector<std::string>& differences) {
    return is_up_to_date(
        c, Code::fitted_stale, fitted.span,
        fmt::format("'{}' in {} was fitted for something else", fitted.name, c.fitted_file->path),
        differences, kFitAgain);
}

}  // namespace

Index check_fitted(Context& c, const ast::Fitted& written, Slot slot, std::string name,
                   Index index) {
    const Method* const method = find_method(c, written.method, slot);
    if (method == nullptr) return kNone;
    FittedCheck check(c, written, *method);
    auto fitted = check.run();
    if (!fitted) return kNone;
    std::vector<Fitted>& all = c.model.fitted;
    const auto same = std::find_if(all.begin(), all.end(), [&](const Fitted& other) {
        return other.slot == Slot::metric && other.declaration == fitted->declaration;
    });
    if (slot == Slot::metric && same != all.end()) return static_cast<Index>(same - all.begin());
    fitted->name = slot == Slot::metric ? fitted->declaration : std::move(name);
    fitted->index = index;
    all.push_back(std::move(*fitted));
    c.fitted_where.push_back(check.where());
    return static_cast<Index>(all.size() - 1);
}

const fitted::Entry* fitted_entry(Context& c, Index index) {
    if (c.options.allow_unfitted) return nullptr;
    Fitted& fitted = c.model.fitted[index];
    if (!c.fitted_is_read) c.fitted_file = read_file(c, fitted);
    c.fitted_is_read = true;
    if (!c.fitted_file) return nullptr;
    const auto found = c.fitted_file->entries.find(fitted.name);
    if (found == c.fitted_file->entries.end()) {
        c.report_data({Code::fitted_missing,
                       fmt::format("{} has no entry for '{}'", c.fitted_file->path, fitted.name),
                       fitted.span})
            .note(std::string(kFitAgain));
        return nullptr;
    }
    const fitted::Entry& entry = found->second;
    std::vector<std::string> differences;
    if (entry.declaration != fitted.declaration)
        differences.push_back(changed("the declaration", entry.declaration, fitted.declaration));
    else if (entry.rows != fitted.rows || entry.columns != fitted.columns)
        differences.push_back(changed("its shape",
                                      fmt::format("{} x {}", entry.rows, entry.columns),
                                      fmt::format("{} x {}", fitted.rows, fitted.columns)));
    fitted.filled = is_current(c, fitted, differences);
    return fitted.filled ? &entry : nullptr;
}

void check_fitted_entries(Context& c) {
    if (!c.fitted_file || c.sink.has_errors()) return;
    for (const Fitted& fitted : c.model.fitted) {
        const fitted::Entry& entry = c.fitted_file->entries.at(fitted.name);
        is_current(c, fitted, differences(entry.reads, reads(c.model, fitted)));
    }
    for (const thresholds::Allowance& allowance : c.fitted_file->allowances)
        c.model.reservations.push_back(thresholds::text(allowance));
}

}  // namespace etlc::check
