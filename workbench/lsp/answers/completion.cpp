#include "lsp/answers/completion.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "lsp/answers/durations.hpp"
#include "lsp/answers/facts.hpp"
#include "lsp/answers/words.hpp"
#include "parse/continuations.hpp"

namespace etlc::lsp {

namespace {

using check::NameKind;
using parse::Role;

constexpr int kKeyword = 14;

/// The protocol's numbers of kinds of items.
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
    switch (role) {
        case Role::operand: {
            const bool scalar = kind == NameKind::input && declared.shape == Shape::scalar;
            if (declaration == "predicate") return scalar || is_number;
            const bool boolean = kind == NameKind::input && declared.shape == Shape::boolean;
            return scalar || boolean || is_number || kind == NameKind::predicate ||
                   kind == NameKind::let;
        }
        case Role::point:
            return kind == NameKind::projection ||
                   (kind == NameKind::input && declared.shape == Shape::embedding);
        case Role::scalar: return kind == NameKind::input && declared.shape == Shape::scalar;
        case Role::target:
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

/// Words that are none of the grammar: check/ knows them.
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
    Items(const Analysis& analysis, source::Span typed)
        : range_(json_of(analysis.lines.range(typed))) {}

    void add(const std::string& label, int kind, const std::string& detail,
             const std::vector<std::string>& sentences = {}) {
        add_at(range_, label, kind, detail);
        if (sentences.empty()) return;
        std::string text;
        for (const std::string& sentence : sentences) text += (text.empty() ? "" : "\n") + sentence;
        items_.back()["documentation"] = text;
    }

    /// In place of another range than the word that is typed.
    void add_at(const Json& range, const std::string& label, int kind, const std::string& detail) {
        // What comes first is meant first.
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

/// Every declaration of the place's kind but the one that is being written.
void add_names(Items& items, const Analysis& analysis, const parse::Continuations& at) {
    for (const Declared& declared : analysis.names.declared) {
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
    // In place of the number that is there already.
    const auto size = static_cast<std::uint32_t>(at.number_before.size());
    std::uint32_t begin = at.typed.begin;
    while (begin > 0 && analysis.file.text({begin - 1, begin}) == " ") --begin;
    if (begin < size || analysis.file.text({begin - size, begin}) != at.number_before) return;
    const bool takes_unit = std::find(at.words.begin(), at.words.end(), "ms") != at.words.end() &&
                            at.declaration != "const" && at.declaration != "period";
    if (!takes_unit) return;
    const Json range = json_of(analysis.lines.range({begin - size, at.typed.end}));
    for (const Duration& duration : durations_near(analysis, at.number_before))
        items.add_at(range, duration.text, kValue, duration.detail);
}

}  // namespace

Json completion(const Analysis& analysis, std::uint32_t offset) {
    const parse::Continuations at = parse::continuations_at(analysis.file, offset);
    Items items(analysis, at.typed);
    add_names(items, analysis, at);
    const bool method = at.role == Role::calibration || at.role == Role::fitting;
    for (const std::string& word : words_of(at.role))
        items.add(word, kKeyword, method ? "method" : "argument");
    add_durations(items, analysis, at);
    for (const std::string& word : at.words) {
        // The grammar takes formulas there, and the language none.
        if (at.declaration == "predicate" && (word == "true" || word == "false")) continue;
        if (const WordInfo* const info = find_word(word))
            items.add(word, item_kind(info->kind), std::string(info->form),
                      {std::string(info->meaning)});
    }
    return {{"isIncomplete", false}, {"items", items.take()}};
}

}  // namespace etlc::lsp
