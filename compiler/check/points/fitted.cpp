#include "check/points/fitted.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "check/context/steps.hpp"
#include "check/numbers/decimal.hpp"
#include "check/points/points.hpp"

namespace etlc::check {

namespace {

using diag::Code;
using Slot = Fitted::Slot;

/// What a method gives, and the numbers that it takes besides `of` and `where`.
struct Method {
    std::string_view word;
    FittedMethod method;
    Slot slot;
    std::string_view count;  ///< k, rows of a target, or r, of a projection; empty: it has none
    bool away = false;       ///< may be told how far from a change of `where` frames are taken
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
    auto& error = c.report(Code::unknown_fitting, name.span,
                           fmt::format("'{}' does not fit {}; expected {}", name.text, word(slot),
                                       diag::alternatives(words)));
    if (const auto near = diag::nearest_name(name.text, words)) diag::did_you_mean(error, *near);
    return nullptr;
}

/// How the method is written.
std::string form(const Method& method) {
    return fmt::format("fitted({}{}, of = POINT, where = FORMULA)", method.word,
                       method.count.empty() ? "" : fmt::format(", {} = 8", method.count));
}

class FittedCheck {
public:
    FittedCheck(Context& context, const ast::Fitted& written, const Method& method)
        : c_(context), written_(written), method_(method) {}

    /// Without its name and slot; nothing where an argument had an error.
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
        } else if (number == nullptr) {
            where_ = std::get<ast::FormulaPtr>(argument.value).get();
        } else if (key == "away") {
            fitted_.away = whole(key, *number, 0, kMaxBound);
        } else {
            count_ = number;
        }
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

Index add(Context& c, Fitted fitted, const ast::Formula* where) {
    c.model.fitted.push_back(std::move(fitted));
    c.fitted_where.push_back(where);
    return static_cast<Index>(c.model.fitted.size() - 1);
}

}  // namespace

Index check_fitted(Context& c, const ast::Fitted& written, Slot slot, const std::string& name,
                   Index index) {
    const Method* const method = find_method(c, written.method, slot);
    if (method == nullptr) return kNone;
    FittedCheck check(c, written, *method);
    auto fitted = check.run();
    if (!fitted) return kNone;
    fitted->name = name;
    fitted->index = index;
    return add(c, std::move(*fitted), check.where());
}

Index check_fitted_metric(Context& c, const ast::Fitted& written) {
    const Method* const method = find_method(c, written.method, Slot::metric);
    if (method == nullptr) return kNone;
    FittedCheck check(c, written, *method);
    auto fitted = check.run();
    if (!fitted) return kNone;
    const auto same =
        std::find_if(c.model.fitted.begin(), c.model.fitted.end(), [&](const Fitted& other) {
            return other.slot == Slot::metric && other.declaration == fitted->declaration;
        });
    if (same != c.model.fitted.end()) return static_cast<Index>(same - c.model.fitted.begin());
    fitted->name = fitted->declaration;
    return add(c, std::move(*fitted), check.where());
}

}  // namespace etlc::check
