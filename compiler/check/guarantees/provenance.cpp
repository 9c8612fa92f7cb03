#include "check/guarantees/provenance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include "check/guarantees/guarantees.hpp"
#include "check/model/fingerprint.hpp"
#include "check/numbers/decimal.hpp"
#include "data/files/hash.hpp"

namespace etlc::check {

namespace {

/// Precedes the hash of what is too long to print: "weights #0123456789abcdef".
constexpr std::string_view kHashed = " #";

// Where labels come from, if not from a truth alone. No formula begins like this.
constexpr std::string_view kArray = "an array or table";
constexpr std::string_view kInPlaceOf = "an array or table in place of ";
constexpr std::string_view kBeside = "an array or table, or ";

/// Whether the atoms of a formula are comparisons or truths.
enum class Atoms : std::uint8_t { compared, truths };

std::string_view word(InputType type) {
    constexpr std::array<std::string_view, 5> kWords{"scalar", "bool", "f32", "f16", "i8"};
    return kWords[static_cast<std::size_t>(type)];
}

std::string_view word(Restarts restarts) {
    constexpr std::array<std::string_view, 3> kWords{"", "restartable ", "repeating "};
    return kWords[static_cast<std::size_t>(restarts)];
}

class Writer {
public:
    Writer(const Model& model, const Labelling& labelling) : model_(model), labelling_(labelling) {
        // Constants and durations count as the numbers that replaced them; list elements are added
        // where they are used.
        const auto& [name, retargetable, constants, file, step_seconds, rounded, rounding, encoders,
                     encoded, inputs, projections, points, targets, fitted, distances, pasts,
                     predicates, formulas, lets, truths, monitors, drifts, dependencies,
                     reservations] = model;
        // Episodes at another rate have different frames.
        if (step_seconds > 0) add("rate", fmt::format("{:.9g} s a step", step_seconds));
    }

    void add_calibrated(Index index) {
        // Only the left side counts: the threshold is the result, and missing samples have no
        // score, but may be losses. Ranges follow from the expression.
        const auto& [name, text, expression, comparison, threshold, delta, robustness, missing,
                     inputs, span] = model_.predicates[index];
        add_expression(expression);
        add("predicate " + name,
            fmt::format("{} {}{}", print(model_, expression), symbol(comparison),
                        threshold.origin == ThresholdOrigin::risk && missing
                            ? fmt::format(" missing {}", *missing)
                            : ""));
        add_truth(index);
    }

    void add_monitor(const Monitor& monitor) {
        // The entry has method, alpha and `against`; the shift is the result.
        const auto& [name, formula, sliding, restarts, horizon, ahead, calibration, duration, span,
                     truth] = monitor;
        add("monitor " + name,
            fmt::format("{}{}", word(restarts),
                        sliding ? fmt::format("sliding, horizon {}", horizon) : "monitor"));
        add("formula " + name, text_of(formula, Atoms::compared));
        if (duration || (calibration && calibration->origin == ThresholdOrigin::normal))
            return;  // it reads no truth
        const std::string over_truths = text_of(monitor.true_formula(), Atoms::truths);
        if (truth != kNone) add("truth of the formula " + name, over_truths);
    }

    void add_fitted(const Fitted& fitted) {
        // The values are the result.
        const auto& [name, declaration, method, rows, columns, away, point, where, slot, index,
                     filled, span] = fitted;
        add("fitted",
            fmt::format("slot {}, method {}, {} x {}, away {}, of {}", static_cast<int>(slot),
                        static_cast<int>(method), rows, columns, away, add_point(point)));
        add("where", where == kNone ? "true" : text_of(where, Atoms::truths));
    }

    Reads take() && {
        Reads result;
        for (const auto& [key, texts] : texts_)
            result[key] = fmt::format("{}", fmt::join(texts, " and "));
        return result;
    }

private:
    void add_input(Index index) {
        const auto& [name, type, dimension, scale, range, has_range, hold, missing, stale_after,
                     encoder, span] = model_.inputs[index];
        std::string text = fmt::format("{}[{}]", word(type), dimension);
        if (scale != 1) text += fmt::format(" scale {}", scale);
        if (has_range) text += fmt::format(" in [{}, {}]", range.low, range.high);
        if (hold > 0) text += fmt::format(" hold {}", hold);
        if (missing) text += fmt::format(" missing {}", *missing);
        if (encoder != kNone) text += " by " + add_encoder(encoder);
        if (stale_after > 0) text += fmt::format(", stale after {}", stale_after);
        add("input " + name, std::move(text));
    }

    std::string add_encoder(Index index) {
        // The fingerprint covers the model, the preprocessing and the runtime.
        const auto& [name, model, preprocessor, image, mean, deviation, filter, resize, flip,
                     channels, margins, output, pool, declaration, dimension, fingerprint,
                     references, otherwise, span] = model_.encoders[index];
        add("encoder " + name,
            fingerprint.empty() ? declaration : hashed("model and settings", fingerprint));
        return name;
    }

    void add_projection(Index index) {
        // The hash covers matrix and offset, from any source.
        // The space only says what may be compared.
        const auto& [name, rows, dimension, matrix, offset, origin, path, hash, fitted, space,
                     span] = model_.projections[index];
        add("projection " + name,
            fmt::format("{} x {}, {}", rows, dimension, hashed("values", hash)));
    }

    std::string add_point(Index point) {
        // The text has delays, factors, and the names of inputs and projections, which are added.
        const auto& [kind, inputs, dimension, projection, inner, steps, parts, factors, text] =
            model_.points[point];
        for (const Index input : inputs) add_input(input);
        if (projection != kNone) add_projection(projection);
        if (inner != kNone) add_point(inner);
        for (const Index part : parts) add_point(part);
        return text;
    }

    /// Returns its name.
    std::string add_target(Index index) {
        // The hash covers the rows, from any source. Projected rows follow from the declared ones
        // and the maps of the point.
        const auto& [name, rows, dimension, values, origin, path, hash, encoded, space, source,
                     fitted, span] = model_.targets[index];
        if (source != kNone) return add_target(source);
        std::string text = fmt::format("{} x {}, {}", rows, dimension, hashed("values", hash));
        if (space != kNone) text += " of " + add_point(space);
        add("target " + name, std::move(text));
        return name;
    }

    void add_distance(Index index) {
        // Expressions contain the text, which describes the distance in words.
        const auto& [point, target, other, metric, aggregation, kth, weights, weights_diagonal,
                     weights_fitted, weights_path, text, span] = model_.distances[index];
        std::string all =
            fmt::format("{} {} {} from {} to {}", word(aggregation), kth,
                        kMetrics[static_cast<std::size_t>(metric)].word, add_point(point),
                        target == kNone ? add_point(other) : add_target(target));
        if (metric == Metric::mahalanobis)
            all += fmt::format(", {}{}", weights_diagonal ? "diagonal, " : "",
                               hashed("weights", weights_hash(model_.distances[index])));
        add("distance " + text, std::move(all));
    }

    void add_past(Index index) {
        // Expressions contain the text, which describes it in words.
        const auto& [kind, expression, steps, text, range, span] = model_.pasts[index];
        add_expression(expression);
    }

    void add_expression(const Expr& expression) {
        // print() writes the numbers from the text.
        const auto& [kind, text, number, number32, index, arguments, span] = expression;
        if (kind == Expr::Kind::scalar) add_input(index);
        if (kind == Expr::Kind::distance) add_distance(index);
        if (kind == Expr::Kind::past) add_past(index);
        for (const Expr& argument : arguments) add_expression(argument);
    }

    static std::string text_of(const Threshold& threshold) {
        // The entry of a calibrated threshold describes its origin. Adaptive thresholds are not
        // used in such formulas.
        const auto& [origin, text, alpha, beta, against, within, value64, value, inner, n, k,
                     inner_n, inner_k, by_group, adaptation, span] = threshold;
        if (origin == ThresholdOrigin::literal) return Decimal::parse(text).text();
        if (inner) return fmt::format("{} and {} from {}", *inner, value, text);
        return fmt::format("{} from {}", value, text);
    }

    /// Adds the comparison of a predicate.
    void add_predicate(Index index) {
        // The ranges follow from the rest, the inputs from the expression.
        const auto& [name, text, expression, comparison, threshold, delta, robustness, missing,
                     inputs, span] = model_.predicates[index];
        add_expression(expression);
        std::string all = fmt::format("{} {} {}", print(model_, expression), symbol(comparison),
                                      text_of(threshold));
        if (missing) all += fmt::format(" missing {}", *missing);
        add("predicate " + model_.predicates[index].shown(), std::move(all));
    }

    /// Adds the source of a predicate's labels.
    void add_truth(Index of) {
        if (model_.predicates[of].threshold.origin == ThresholdOrigin::normal) return;
        std::string text = is_own_truth(model_, of) ? "its comparison" : "";
        if (!text.empty()) add_predicate(of);
        for (const Truth& truth : model_.truths) {
            const auto& [predicate, formula, span] = truth;
            if (predicate == of && formula != kNone) text = text_of(formula, Atoms::compared);
        }
        const auto found = labelling_.from_arrays.find(of);
        if (text.empty())
            text = kArray;
        else if (found != labelling_.from_arrays.end() && found->second > 0)
            text.insert(0, found->second == labelling_.episodes ? kInPlaceOf : kBeside);
        add("truth " + model_.predicates[of].shown(), std::move(text));
    }

    /// Returns the text of a formula, and adds what its atoms read. A long one contains names of
    /// lets, which are added.
    std::string text_of(Index root, Atoms atoms) {
        const bool names_lets = !lets_are_written_out(model_, root);
        for (const Index i : parts_of(model_, root)) {
            const auto& [kind, index, each_step, operands, low, high, time, span] =
                model_.formulas[i];
            if (kind == Formula::Kind::boolean_input) add_input(index);
            if (kind == Formula::Kind::predicate)
                atoms == Atoms::compared ? add_predicate(index) : add_truth(index);
            for (const Let& let : model_.lets)
                if (names_lets && let.formula == i) add("let " + let.name, print(model_, i));
        }
        return print(model_, root);
    }

    static std::string hashed(std::string_view what, const std::string& hash) {
        return fmt::format("{}{}{}", what, kHashed, hash);
    }

    void add(const std::string& key, std::string text) { texts_[key].insert(std::move(text)); }

    const Model& model_;
    const Labelling& labelling_;
    /// Texts by key, one each; if two things ever have the same key, both are kept.
    std::map<std::string, std::set<std::string>> texts_;
};

/// Returns the indices in all atoms of one kind in a formula.
std::set<Index> atoms_in(const Model& model, Index formula, Formula::Kind kind) {
    std::set<Index> found;
    for (const Index i : parts_of(model, formula))
        if (model.formulas[i].kind == kind) found.insert(model.formulas[i].index);
    return found;
}

/// Returns a truth without the arrays that labels came from instead.
std::string_view stated(std::string_view text) {
    for (const std::string_view phrase : {kInPlaceOf, kBeside})
        if (text.starts_with(phrase)) return text.substr(phrase.size());
    return text;
}

/// A text without its hash, and what the hash is of: "weights".
struct Printed {
    std::string_view text;
    std::string_view hashed;
};
Printed printed(std::string_view text) {
    constexpr std::size_t kDigits = 16;
    const std::size_t hash = text.rfind(kHashed);
    if (hash == std::string_view::npos) return {text, {}};
    const std::size_t digits = text.size() - hash - kHashed.size();
    if (digits != 0 && digits != kDigits) return {text, {}};  // 0: of values that are not known
    text = text.substr(0, hash);
    const std::size_t comma = text.rfind(", ");
    return comma == std::string_view::npos ? Printed{{}, text}
                                           : Printed{text.substr(0, comma), text.substr(comma + 2)};
}

std::string difference(const std::string& key, const std::string& then, const std::string& now) {
    const Printed before = printed(then);
    const Printed after = printed(now);
    if (before.text != after.text)
        return changed(key, before.text.empty() ? then : before.text,
                       after.text.empty() ? now : after.text);
    return before.hashed.empty() ? changed(key, then, now)
                                 : fmt::format("the {} of {} changed", before.hashed, key);
}

}  // namespace

Reads reads(const Model& model, Index predicate, const Labelling& labelling) {
    Writer writer(model, labelling);
    writer.add_calibrated(predicate);
    return std::move(writer).take();
}

Reads reads(const Model& model, const Monitor& monitor, const Labelling& labelling) {
    Writer writer(model, labelling);
    writer.add_monitor(monitor);
    return std::move(writer).take();
}

Reads reads(const Model& model, const Fitted& fitted, const Labelling& labelling) {
    Writer writer(model, labelling);
    writer.add_fitted(fitted);
    return std::move(writer).take();
}

bool replaces_truths(const Reads& reads) {
    return std::any_of(reads.begin(), reads.end(), [](const auto& read) {
        return stated(read.second).size() < read.second.size();
    });
}

std::string changed(std::string_view what, std::string_view then, std::string_view now) {
    return fmt::format("{} was: {}; it is: {}", what, then, now);
}

std::vector<std::string> differences(const Reads& then, const Reads& now) {
    std::vector<std::string> found;
    for (const auto& [key, text] : now)
        if (const auto before = then.find(key);
            before != then.end() && stated(before->second) != text)
            found.push_back(difference(key, before->second, text));
    if (!found.empty()) return found;  // these explain what else is read now
    for (const auto& [key, text] : then)
        if (!now.contains(key)) found.push_back(changed(key, text, "not read"));
    for (const auto& [key, text] : now)
        if (!then.contains(key)) found.push_back(changed(key, "not read", text));
    return found;
}

std::vector<Index> predicates_of(const Model& model, Index formula) {
    const std::set<Index> found = atoms_in(model, formula, Formula::Kind::predicate);
    return {found.begin(), found.end()};
}

std::vector<Index> predicates_of(const Model& model, const Monitor& monitor) {
    std::set<Index> found = atoms_in(model, monitor.formula, Formula::Kind::predicate);
    found.merge(atoms_in(model, monitor.true_formula(), Formula::Kind::predicate));
    return {found.begin(), found.end()};
}

std::vector<Index> flags_of(const Model& model, Index formula) {
    const std::set<Index> found = atoms_in(model, formula, Formula::Kind::boolean_input);
    return {found.begin(), found.end()};
}

}  // namespace etlc::check
