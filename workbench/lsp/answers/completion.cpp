#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "check/numbers/decimal.hpp"
#include "lsp/answers/answers.hpp"
#include "lsp/spec/analysis.hpp"
#include "parse/continuations.hpp"

namespace etlc::lsp {

namespace {

using check::NameKind;
using parse::Role;

/// A duration that a bound can have at the rate of the spec.
struct Duration {
    std::string text;    ///< "0.5 s"
    std::string detail;  ///< "10 steps"
};

using check::Decimal;
using check::Quantity;

/// Usual durations, from short to long.
constexpr std::pair<std::string_view, std::string_view> kUsual[] = {
    {"1", "ms"},   {"10", "ms"}, {"20", "ms"}, {"50", "ms"}, {"100", "ms"},
    {"200", "ms"}, {"0.5", "s"}, {"1", "s"},   {"2", "s"},   {"5", "s"},
    {"10", "s"},   {"30", "s"},  {"1", "min"}, {"5", "min"}};

constexpr std::array<std::string_view, 4> kUnits{"us", "ms", "s", "min"};

Quantity step_of(const Analysis& analysis) {
    return {Decimal::parse(analysis.checked->step_number), analysis.checked->step_unit};
}

class Found {
public:
    void add(std::string text, std::uint64_t steps, bool rounded) {
        const bool known = std::any_of(all_.begin(), all_.end(),
                                       [&](const Duration& d) { return d.text == text; });
        if (steps == 0 || known || text.starts_with("about")) return;
        if (text.find('/') != std::string::npos) return;  // it is not a finite decimal
        all_.push_back(
            {std::move(text), (rounded ? "rounded to " : "") + diag::counted(steps, "step")});
    }
    std::vector<Duration> take() { return std::move(all_); }

private:
    std::vector<Duration> all_;
};

/// Adds a duration that is a whole number of steps, or is rounded to one.
void add_written(Found& found, const Analysis& analysis, std::string_view number,
                 std::string_view unit, bool with_neighbours) {
    const Quantity step = step_of(analysis);
    const check::StepCount count = check::count_steps({Decimal::parse(number), unit}, step);
    if (count.too_many) return;
    const std::string text = check::with_unit(number, unit);
    const std::string& rounding = analysis.checked->model.rounding;
    if (count.whole) return found.add(text, count.floor, false);
    if (!rounding.empty()) {
        const bool up = rounding == "up" || (rounding == "to the nearest" && count.upper_half);
        return found.add(text, count.floor + (up ? 1 : 0), true);
    }
    if (!with_neighbours || count.floor == 0) return;
    for (const std::uint64_t steps : {count.floor, count.floor + 1})
        found.add(check::duration_text(steps, step, unit), steps, false);
}

/// Returns usual durations; none where the spec has no rate.
std::vector<Duration> durations(const Analysis& analysis) {
    if (analysis.checked->step_number.empty()) return {};
    Found found;
    for (const auto& [number, unit] : kUsual) add_written(found, analysis, number, unit, false);
    return found.take();
}

/// Returns the number with each unit; where that is no whole number of steps, the two neighbours.
std::vector<Duration> durations_near(const Analysis& analysis, const std::string& number) {
    if (analysis.checked->step_number.empty()) return {};
    if (Decimal::parse(number).digits.size() > check::kMaxTimeDigits) return {};
    Found found;
    for (const std::string_view unit : kUnits) add_written(found, analysis, number, unit, true);
    return found.take();
}

constexpr int kKeyword = 14;

/// Returns the protocol's number of a kind of item.
int item_kind(WordInfo::Kind kind) {
    constexpr int kFunction = 3;
    constexpr int kUnit = 11;
    constexpr int kOperator = 24;
    constexpr int kType = 25;
    switch (kind) {
        case WordInfo::Kind::type: return kType;
        case WordInfo::Kind::unit: return kUnit;
        case WordInfo::Kind::operation: return kOperator;
        case WordInfo::Kind::aggregation:
        case WordInfo::Kind::function:
        case WordInfo::Kind::distance: return kFunction;
        case WordInfo::Kind::declaration:
        case WordInfo::Kind::keyword: break;
    }
    return kKeyword;
}

int item_kind(NameKind kind) {
    constexpr int kFunction = 3;
    constexpr int kField = 5;
    constexpr int kVariable = 6;
    constexpr int kConstant = 21;
    switch (kind) {
        case NameKind::constant: return kConstant;
        case NameKind::input: return kField;
        case NameKind::projection:
        case NameKind::encoder: return kFunction;
        default: return kVariable;
    }
}

bool fits(const Declared& declared, Role role, const std::string& declaration) {
    const NameKind kind = *declared.kind;
    if (kind == NameKind::unreadable) return role != Role::none;
    const bool is_number = kind == NameKind::constant && !declared.is_duration;
    const bool is_point = kind == NameKind::projection ||
                          (kind == NameKind::input && declared.shape == Shape::embedding);
    switch (role) {
        case Role::operand: {
            const bool scalar = kind == NameKind::input && declared.shape == Shape::scalar;
            if (declaration == "predicate") return scalar || is_number;
            const bool boolean = kind == NameKind::input && declared.shape == Shape::boolean;
            return scalar || boolean || is_number || kind == NameKind::predicate ||
                   kind == NameKind::let;
        }
        case Role::point: return is_point;
        case Role::scalar:
            return is_point || (kind == NameKind::input && declared.shape == Shape::scalar);
        case Role::target: return is_point || kind == NameKind::target;
        case Role::weights: return kind == NameKind::target;
        case Role::amount: return declaration == "period" ? kind == NameKind::constant : is_number;
        case Role::bound: return kind == NameKind::constant;
        case Role::encoder: return kind == NameKind::encoder;
        case Role::predicate: return kind == NameKind::predicate;
        case Role::none:
        case Role::calibration:
        case Role::fitting:
        case Role::calibration_argument:
        case Role::fitting_argument: break;
    }
    return false;
}

/// Returns the words that the grammar does not list: check/ defines them.
std::vector<std::string> words_of(Role role) {
    if (role == Role::calibration_argument) return {"alpha", "against", "gamma", "lo", "hi"};
    if (role == Role::fitting_argument) return {"k", "r", "away"};
    if (role == Role::calibration) return {"conformal", "class_conditional", "f1", "adaptive"};
    if (role == Role::fitting)
        return {"mean", "medoids", "kmeans", "pca", "whitened_pca", "discriminant", "logpzo"};
    return {};
}

class Items {
public:
    Items(const Analysis& analysis, source::Span typed) : range_(analysis.lines.range(typed)) {}

    void add(const std::string& label, int kind, const std::string& detail,
             const std::vector<std::string>& sentences = {}) {
        add_at(range_, label, kind, detail);
        if (sentences.empty()) return;
        std::string text;
        for (const std::string& sentence : sentences) text += (text.empty() ? "" : "\n") + sentence;
        items_.back()["documentation"] = text;
    }

    /// Adds an item that replaces another range than the typed word.
    void add_at(const Json& range, const std::string& label, int kind, const std::string& detail) {
        // Items keep their order.
        items_.push_back({{"label", label},
                          {"kind", kind},
                          {"detail", detail},
                          {"sortText", fmt::format("{:04}", items_.size())},
                          {"textEdit", {{"range", range}, {"newText", label}}}});
    }

    Json take() { return std::move(items_); }

private:
    Json range_;
    Json items_ = Json::array();
};

/// Adds the names that fit, except that of the declaration that is being written.
void add_names(Items& items, const Analysis& analysis, const parse::Continuations& at) {
    for (const Declared& declared : analysis.names().declared) {
        if (!declared.kind || !fits(declared, at.role, at.declaration)) continue;
        const std::uint32_t name = declared.name_span.begin;
        const bool is_own = at.begin <= name && name <= at.typed.begin;
        if (is_own) continue;
        items.add(declared.name, item_kind(*declared.kind),
                  std::string(check::word(*declared.kind)),
                  facts_of(analysis, declared.name, nullptr));
    }
}

void add_durations(Items& items, const Analysis& analysis, const parse::Continuations& at) {
    constexpr int kValue = 12;
    if (at.in_interval && at.typed.begin == at.typed.end)
        for (const Duration& duration : durations(analysis))
            items.add(duration.text, kValue, duration.detail);
    if (at.number_before.empty()) return;
    // Items replace the number before the cursor.
    const auto size = static_cast<std::uint32_t>(at.number_before.size());
    std::uint32_t begin = at.typed.begin;
    while (begin > 0 && analysis.file.text({begin - 1, begin}) == " ") --begin;
    if (begin < size || analysis.file.text({begin - size, begin}) != at.number_before) return;
    const bool takes_unit = std::find(at.words.begin(), at.words.end(), "ms") != at.words.end() &&
                            at.declaration != "const" && at.declaration != "period";
    if (!takes_unit) return;
    const Json range = analysis.lines.range({begin - size, at.typed.end});
    for (const Duration& duration : durations_near(analysis, at.number_before))
        items.add_at(range, duration.text, kValue, duration.detail);
}

}  // namespace

Json completion(const Question& question) {
    const Analysis& analysis = question.analysis();
    const parse::Continuations at = parse::continuations_at(analysis.file, question.offset());
    Items items(analysis, at.typed);
    add_names(items, analysis, at);
    const bool method = at.role == Role::calibration || at.role == Role::fitting;
    for (const std::string& word : words_of(at.role))
        items.add(word, kKeyword, method ? "method" : "argument");
    add_durations(items, analysis, at);
    for (const std::string& word : at.words) {
        // The grammar allows formulas here, the language does not.
        if (at.declaration == "predicate" && (word == "true" || word == "false")) continue;
        if (const WordInfo* const info = find_word(word))
            items.add(word, item_kind(info->kind), std::string(info->form),
                      {std::string(info->meaning)});
    }
    return {{"isIncomplete", false}, {"items", items.take()}};
}

const std::vector<WordInfo>& all_words() {
    static const std::vector<WordInfo> all{
#define WORD(word, kind, form, meaning) WordInfo{word, WordInfo::Kind::kind, form, meaning},
#include "lsp/answers/words.def"
#undef WORD
    };
    return all;
}

const WordInfo* find_word(std::string_view word) {
    const auto& all = all_words();
    const auto found =
        std::find_if(all.begin(), all.end(), [word](const WordInfo& w) { return w.word == word; });
    return found == all.end() ? nullptr : &*found;
}

}  // namespace etlc::lsp
