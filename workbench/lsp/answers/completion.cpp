#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "check/guarantees/guarantees.hpp"
#include "check/numbers/decimal.hpp"
#include "lsp/answers/answers.hpp"
#include "lsp/spec/analysis.hpp"
#include "parse/continuations.hpp"
#include "plan/budget/budget.hpp"

namespace etlc::lsp {

namespace {

using check::NameKind;
using parse::Role;

/// A duration that a bound can have at the rate of the spec.
struct Duration {
    std::string text;    ///< "0.5 s"
    std::string detail;  ///< "10 steps"
};
using Durations = std::vector<Duration>;

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

void add(Durations& found, std::string text, std::uint64_t steps, bool rounded) {
    const bool known =
        std::any_of(found.begin(), found.end(), [&](const Duration& d) { return d.text == text; });
    if (steps == 0 || known || text.starts_with("about")) return;
    if (text.find('/') != std::string::npos) return;  // it is not a finite decimal
    found.push_back(
        {std::move(text), (rounded ? "rounded to " : "") + diag::counted(steps, "step")});
}

/// Adds a duration that is a whole number of steps, or is rounded to one.
void add_written(Durations& found, const Analysis& analysis, std::string_view number,
                 std::string_view unit, bool with_neighbours) {
    const Quantity step = step_of(analysis);
    const check::StepCount count = check::count_steps({Decimal::parse(number), unit}, step);
    if (count.too_many) return;
    const std::string text = check::with_unit(number, unit);
    const std::string& rounding = analysis.checked->model.rounding;
    if (count.whole) return add(found, text, count.floor, false);
    if (!rounding.empty()) {
        const bool up = rounding == "up" || (rounding == "to the nearest" && count.upper_half);
        return add(found, text, count.floor + (up ? 1 : 0), true);
    }
    if (!with_neighbours || count.floor == 0) return;
    for (const std::uint64_t steps : {count.floor, count.floor + 1})
        add(found, check::duration_text(steps, step, unit), steps, false);
}

/// Returns usual durations; none where the spec has no rate.
Durations durations(const Analysis& analysis) {
    if (analysis.checked->step_number.empty()) return {};
    Durations found;
    for (const auto& [number, unit] : kUsual) add_written(found, analysis, number, unit, false);
    return found;
}

/// Returns the number with each unit; where that is no whole number of steps, the two neighbours.
Durations durations_near(const Analysis& analysis, const std::string& number) {
    if (analysis.checked->step_number.empty()) return {};
    if (Decimal::parse(number).digits.size() > check::kMaxTimeDigits) return {};
    Durations found;
    for (const std::string_view unit : kUnits) add_written(found, analysis, number, unit, true);
    return found;
}

/// Kinds of items, as the protocol numbers them.
enum class ItemKind {
    function = 3,
    field = 5,
    variable = 6,
    unit = 11,
    value = 12,
    keyword = 14,
    constant = 21,
    operation = 24,
    type = 25
};

ItemKind item_kind(WordInfo::Kind kind) {
    switch (kind) {
        case WordInfo::Kind::type: return ItemKind::type;
        case WordInfo::Kind::unit: return ItemKind::unit;
        case WordInfo::Kind::operation: return ItemKind::operation;
        case WordInfo::Kind::function: return ItemKind::function;
        case WordInfo::Kind::keyword:
        case WordInfo::Kind::argument: break;
    }
    return ItemKind::keyword;
}

ItemKind item_kind(NameKind kind) {
    switch (kind) {
        case NameKind::constant: return ItemKind::constant;
        case NameKind::input: return ItemKind::field;
        case NameKind::projection:
        case NameKind::encoder: return ItemKind::function;
        default: return ItemKind::variable;
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
        case Role::watched: return kind == NameKind::predicate || kind == NameKind::monitor;
        case Role::none:
        case Role::calibration:
        case Role::fitting:
        case Role::calibration_argument:
        case Role::drift_argument:
        case Role::fitting_argument: break;
    }
    return false;
}

/// Returns the words that the grammar does not list: check/ defines them.
std::vector<std::string> words_of(Role role) {
    if (role == Role::calibration_argument)
        return {"alpha", "beta", "against", "within", "gamma", "lo", "hi"};
    if (role == Role::drift_argument) return {"level"};
    if (role == Role::fitting_argument) return {"k", "r", "away"};
    if (role == Role::calibration)
        return {"conformal", "normal", "risk", "class_conditional", "f1", "adaptive"};
    if (role == Role::fitting)
        return {"mean", "medoids", "kmeans", "pca", "whitened_pca", "discriminant", "logpzo"};
    return {};
}

class Items {
public:
    Items(const Analysis& analysis, source::Span typed) : range_(analysis.lines.range(typed)) {}

    void add(const std::string& label, ItemKind kind, const std::string& detail,
             const std::vector<std::string>& sentences = {}) {
        add_at(range_, label, kind, detail);
        if (!sentences.empty())
            items_.back()["documentation"] = fmt::format("{}", fmt::join(sentences, "\n"));
    }

    /// Adds an item that replaces another range than the typed word.
    void add_at(const Json& range, const std::string& label, ItemKind kind,
                const std::string& detail) {
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
    if (at.in_interval && at.typed.begin == at.typed.end)
        for (const Duration& duration : durations(analysis))
            items.add(duration.text, ItemKind::value, duration.detail);
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
        items.add_at(range, duration.text, ItemKind::value, duration.detail);
}

}  // namespace

Json completion(const Question& question) {
    const Analysis& analysis = question.analysis();
    const parse::Continuations at = parse::continuations_at(analysis.file, question.offset());
    Items items(analysis, at.typed);
    add_names(items, analysis, at);
    const bool method = at.role == Role::calibration || at.role == Role::fitting;
    for (const std::string& word : words_of(at.role))
        items.add(word, ItemKind::keyword, method ? "method" : "argument");
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

namespace {

using check::Index;
using check::Model;
using Sentences = std::vector<std::string>;

std::string type_of(const check::Input& input) {
    switch (input.type) {
        case check::InputType::boolean: return "a bool";
        case check::InputType::scalar: return "a scalar in float32";
        case check::InputType::f32:
            return fmt::format("an embedding of dimension {} in float32", input.dimension);
        case check::InputType::f16:
            return fmt::format("an embedding of dimension {} in float16", input.dimension);
        case check::InputType::i8: break;
    }
    return fmt::format("an embedding of dimension {} in int8, times {}", input.dimension,
                       input.scale);
}

Sentences about(const Model& model, const check::Input& input) {
    Sentences facts{"Input: " + type_of(input) + "."};
    if (input.has_range)
        facts.push_back(fmt::format("A sample outside [{}, {}] counts as missing.", input.range.low,
                                    input.range.high));
    if (input.hold > 0)
        facts.push_back(fmt::format("The last sample stands in for up to {} missing ones in a row.",
                                    input.hold));
    if (input.stale_after > 0)
        facts.push_back(
            fmt::format("A sample counts as missing when it has come more than {} in a row.",
                        diag::counted(input.stale_after, "time")));
    if (input.missing)
        facts.push_back(fmt::format("Where it is missing it counts as {}.", *input.missing));
    if (input.encoder < model.encoders.size())
        facts.push_back(fmt::format("Made of images by '{}'.", model.encoders[input.encoder].name));
    return facts;
}

std::string origin_in_words(const std::string& origin) {
    if (origin == "literal") return "written in the spec";
    return origin == "fitted" ? origin : "from " + origin;
}

Sentences about(const Model& model, const check::Target& target) {
    Sentences facts{fmt::format("Target: {} of dimension {}, {}.",
                                diag::counted(target.rows, "row"), target.dimension,
                                origin_in_words(target.origin))};
    if (target.space < model.points.size())
        facts.push_back(
            fmt::format("Its rows are in the space of {}.", model.points[target.space].text));
    if (target.fitted < model.fitted.size() && !model.fitted[target.fitted].filled)
        facts.emplace_back("It is not fitted yet: 'etlc fit' finds it.");
    return facts;
}

Sentences about(const Model& model, const check::Projection& projection) {
    Sentences facts{fmt::format("Projection: from dimension {} to {}, {}.", projection.dimension,
                                projection.rows, origin_in_words(projection.origin))};
    if (projection.fitted < model.fitted.size() && !model.fitted[projection.fitted].filled)
        facts.emplace_back("It is not fitted yet: 'etlc fit' finds it.");
    return facts;
}

Sentences about(const check::Encoder& encoder) {
    Sentences facts{fmt::format("Encoder: the model {}.", encoder.model)};
    if (encoder.dimension > 0)
        facts.push_back(fmt::format("It gives {} numbers.", encoder.dimension));
    if (encoder.fingerprint.empty())
        facts.emplace_back("'etlc embed' has not been run with it yet.");
    return facts;
}

Sentences about(const Model& model, Index index) {
    const check::Predicate& predicate = model.predicates[index];
    const check::Threshold& threshold = predicate.threshold;
    Sentences facts;
    const bool known = !std::isnan(threshold.value);
    facts.push_back(fmt::format("Predicate: {}{}.", predicate.text,
                                known ? check::numbers(threshold) : threshold.text));
    facts.push_back(known ? fmt::format("Threshold {}: {}.", check::numbers(threshold),
                                        check::origin(threshold))
                          : fmt::format("Threshold: {}, not there yet; 'etlc calibrate' finds it.",
                                        threshold.text));
    if (known && threshold.adaptation)
        facts.push_back(fmt::format("Of T labelled positive frames it misses at most {}.",
                                    check::miss_bound(predicate)));
    if (known && !predicate.equality())
        facts.push_back(fmt::format("Robustness in [{}, {}].", predicate.robustness.low,
                                    predicate.robustness.high));
    if (predicate.missing)
        facts.push_back(
            fmt::format("Where a sample is missing it counts as {}.", *predicate.missing));
    return facts;
}

std::string kind_of(const check::Monitor& monitor) {
    if (monitor.sliding)
        return fmt::format("Sliding monitor: about every step, {} late.",
                           diag::counted(monitor.horizon, "step"));
    switch (monitor.restarts) {
        case check::Restarts::never: break;
        case check::Restarts::on_request:
            return "Restartable monitor: about the step at which the program last restarted it.";
        case check::Restarts::when_final:
            return "Repeating monitor: about the present cycle, the next after each final verdict.";
    }
    return "Monitor: about the first step.";
}

Sentences about(const Model& model, const check::Monitor& monitor, bool complete,
                const Planned* planned) {
    Sentences facts{kind_of(monitor)};
    if (complete) {
        for (const check::Guarantee& guarantee : check::guarantees(model, monitor)) {
            if (guarantee.part.empty() && guarantee.kind == check::Guarantee::Kind::nothing)
                facts.push_back(fmt::format("No guarantee: {}.", guarantee.why));
            else
                facts.push_back(fmt::format("Guarantee: {}.", check::text(guarantee)));
        }
    }
    if (monitor.calibration && complete)
        facts.push_back(
            fmt::format("Calibrated as a whole: {}.", check::of_shift(*monitor.calibration)));
    if (monitor.duration && complete)
        facts.push_back(
            fmt::format("Calibrated: {}.", check::of_duration(model, *monitor.duration)));
    if (planned == nullptr || !planned->compiled) return facts;
    const plan::Plan& plan = planned->compiled->plan;
    for (std::size_t m = 0; m < plan.monitors.size() && m < plan.monitor_costs.size(); ++m)
        if (plan.monitors[m].name == monitor.name)
            facts.push_back(fmt::format("Budget: {}.", plan::in_words(plan.monitor_costs[m])));
    return facts;
}

Sentences about(const Model& model, const check::Let& let) {
    if (let.formula >= model.formulas.size()) return {};
    return {fmt::format("Let: {}.", check::shown(model, let.formula))};
}

Sentences about(const check::Drift& drift) {
    return {
        fmt::format("Drift: alarms when episodes no longer score like those of calibration; "
                    "without reason ever with probability <= {}.",
                    drift.level)};
}

Sentences about(const check::Constant& constant) {
    return {fmt::format("Constant: {}.", constant.text)};
}

}  // namespace

Sentences facts_of(const Analysis& analysis, const std::string& name, const Planned* planned) {
    const check::Inspected& checked = *analysis.checked;
    const check::Inspected::Named* const named = checked.find(name);
    if (named == nullptr) return {};
    const Model& model = checked.model;
    const Index i = named->index;
    const auto in = [i](const auto& all) { return i < all.size(); };
    using check::NameKind;
    switch (named->kind) {
        case NameKind::constant:
            for (const check::Constant& constant : model.constants)
                if (constant.name == name) return about(constant);
            return {};
        case NameKind::encoder: return in(model.encoders) ? about(model.encoders[i]) : Sentences{};
        case NameKind::input: return in(model.inputs) ? about(model, model.inputs[i]) : Sentences{};
        case NameKind::projection:
            return in(model.projections) ? about(model, model.projections[i]) : Sentences{};
        case NameKind::target:
            return in(model.targets) ? about(model, model.targets[i]) : Sentences{};
        case NameKind::predicate: return in(model.predicates) ? about(model, i) : Sentences{};
        case NameKind::let: return in(model.lets) ? about(model, model.lets[i]) : Sentences{};
        case NameKind::monitor:
            return in(model.monitors) ? about(model, model.monitors[i], checked.complete, planned)
                                      : Sentences{};
        case NameKind::drift: return in(model.drifts) ? about(model.drifts[i]) : Sentences{};
        case NameKind::unreadable: break;
    }
    return {};
}

}  // namespace etlc::lsp
