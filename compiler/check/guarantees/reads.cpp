// Describes everything that a guarantee depends on as text.
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

/// Marks hashes of what is too long to print.
constexpr char kHashed = '#';

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

class Reading {
public:
    explicit Reading(const Model& model) : model_(model) {
        // Constants and durations count as the numbers that replaced them; list elements are added
        // where they are used.
        const auto& [name, retargetable, constants, file, step_seconds, rounded, rounding, encoders,
                     encoded, inputs, projections, points, targets, fitted, distances, pasts,
                     predicates, formulas, lets, truths, monitors, dependencies, reservations] =
            model;
        // Episodes at another rate have different frames.
        if (step_seconds > 0) add("rate", fmt::format("{:.9g} s a step", step_seconds));
    }

    void add_calibrated(Index index) {
        // Only the left side counts: the threshold is the result, and missing samples have no
        // score. Ranges follow from the expression.
        const auto& [name, text, expression, comparison, threshold, delta, robustness, missing,
                     inputs, span] = model_.predicates[index];
        add_expression(expression);
        add("predicate " + name,
            fmt::format("{} {}", print(model_, expression), symbol(comparison)));
        add_truth(index);
    }

    void add_monitor(const Monitor& monitor) {
        // The entry has method, alpha and `against`; the shift is the result.
        const auto& [name, formula, sliding, restarts, horizon, calibration, span, truth] = monitor;
        add("monitor " + name,
            fmt::format("{}{}", word(restarts),
                        sliding ? fmt::format("sliding, horizon {}", horizon) : "monitor"));
        add("formula " + name, hash_of(formula, Atoms::compared));
        const std::string over_truths = hash_of(monitor.true_formula(), Atoms::truths);
        if (truth != kNone) add("truth of the formula " + name, over_truths);
    }

    void add_fitted(const Fitted& fitted) {
        // The values are the result.
        const auto& [name, declaration, method, rows, columns, away, point, where, slot, index,
                     filled, span] = fitted;
        add("fitted",
            fmt::format("slot {}, method {}, {} x {}, away {}, of {}", static_cast<int>(slot),
                        static_cast<int>(method), rows, columns, away, text_of(point)));
        add("where", where == kNone ? "true" : hash_of(where, Atoms::truths));
    }

    Reads take() && {
        Reads result;
        for (const auto& [key, texts] : texts_)
            result[key] = fmt::format("{}", fmt::join(texts, " and "));
        return result;
    }

private:
    std::string add_input(Index index) {
        const auto& [name, type, dimension, scale, range, has_range, hold, missing, stale_after,
                     encoder, span] = model_.inputs[index];
        std::string text = fmt::format("{}[{}]", word(type), dimension);
        if (scale != 1) text += fmt::format(" scale {}", scale);
        if (has_range) text += fmt::format(" in [{}, {}]", range.low, range.high);
        if (hold > 0) text += fmt::format(" hold {}", hold);
        if (missing) text += fmt::format(" missing {}", *missing);
        if (encoder != kNone) text += " by " + add_encoder(encoder);
        if (stale_after > 0) text += fmt::format(", stale after {}", stale_after);
        return add("input " + name, std::move(text));
    }

    std::string add_encoder(Index index) {
        // The fingerprint covers the model, the preprocessing and the runtime.
        const auto& [name, model, preprocessor, image, mean, deviation, filter, resize, flip,
                     channels, margins, output, pool, declaration, dimension, fingerprint,
                     references, otherwise, span] = model_.encoders[index];
        add("encoder " + name, fingerprint.empty() ? declaration : kHashed + fingerprint);
        return name;
    }

    void add_projection(Index index) {
        // The hash covers matrix and offset, from any source.
        const auto& [name, rows, dimension, matrix, offset, origin, path, hash, fitted, span] =
            model_.projections[index];
        add("projection " + name, fmt::format("{} x {}, {}{}", rows, dimension, kHashed, hash));
    }

    std::string text_of(Index point) {
        // The text has delays, and the names of inputs and projections, which are added.
        const auto& [kind, inputs, dimension, projection, inner, steps, parts, text] =
            model_.points[point];
        for (const Index input : inputs) add_input(input);
        if (projection != kNone) add_projection(projection);
        if (inner != kNone) text_of(inner);
        for (const Index part : parts) text_of(part);
        return text;
    }

    /// Returns its name.
    std::string add_target(Index index) {
        // The hash covers the rows, from any source. Projected rows follow from the declared ones
        // and the maps of the point.
        const auto& [name, rows, dimension, values, origin, path, hash, encoded, space, source,
                     fitted, span] = model_.targets[index];
        if (source != kNone) return add_target(source);
        std::string text = fmt::format("{} x {}, {}{}", rows, dimension, kHashed, hash);
        if (space != kNone) text += " of " + text_of(space);
        add("target " + name, std::move(text));
        return name;
    }

    void add_distance(Index index) {
        // Expressions contain the text, which describes the distance in words.
        const auto& [point, target, other, metric, aggregation, kth, weights, weights_diagonal,
                     weights_fitted, weights_path, text, span] = model_.distances[index];
        std::string all =
            fmt::format("{} {} {} from {} to {}", word(aggregation), kth,
                        kMetrics[static_cast<std::size_t>(metric)].word, text_of(point),
                        target == kNone ? text_of(other) : add_target(target));
        if (metric == Metric::mahalanobis)
            all += fmt::format(", {}{}{}", weights_diagonal ? "diagonal " : "", kHashed,
                               weights_hash(model_.distances[index]));
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
        const auto& [origin, text, alpha, value64, value, n, k, by_group, adaptation, span] =
            threshold;
        if (origin == ThresholdOrigin::literal) return Decimal::parse(text).text();
        return fmt::format("{} from {}", value, text);
    }

    /// Adds the comparison of a predicate.
    std::string add_predicate(Index index) {
        // The ranges follow from the rest, the inputs from the expression.
        const auto& [name, text, expression, comparison, threshold, delta, robustness, missing,
                     inputs, span] = model_.predicates[index];
        add_expression(expression);
        std::string all = fmt::format("{} {} {}", print(model_, expression), symbol(comparison),
                                      text_of(threshold));
        if (missing) all += fmt::format(" missing {}", *missing);
        return add("predicate " + model_.predicates[index].shown(), std::move(all));
    }

    /// Adds the source of a predicate's labels.
    std::string add_truth(Index of) {
        const std::string key = "truth " + model_.predicates[of].shown();
        for (const Truth& truth : model_.truths) {
            const auto& [predicate, formula, span] = truth;
            if (predicate == of && formula != kNone)
                return add(key, hash_of(formula, Atoms::compared));
        }
        if (!is_own_truth(model_, of)) return add(key, "array");
        add_predicate(of);
        return add(key, "its comparison");
    }

    std::string add_atom(Index predicate, Atoms atoms) {
        return atoms == Atoms::compared ? add_predicate(predicate) : add_truth(predicate);
    }

    /// Hashes a formula with its lets written out, each part once, and adds what its atoms read.
    std::string hash_of(Index root, Atoms atoms) {
        std::vector<Index> parts = parts_of(model_, root);
        std::reverse(parts.begin(), parts.end());  // operands first
        std::map<Index, std::string> hashes;
        for (const Index i : parts) {
            const auto& [kind, index, operands, low, high, span] = model_.formulas[i];
            // The number of a count would change with every new row of operators.def.
            std::string text = kind == Formula::Kind::count
                                   ? fmt::format("count {} [{}, {}]", index, low, high)
                                   : fmt::format("{} [{}, {}]", static_cast<int>(kind), low, high);
            if (kind == Formula::Kind::predicate) text += ' ' + add_atom(index, atoms);
            if (kind == Formula::Kind::boolean_input) text += ' ' + add_input(index);
            for (const Index operand : operands) text += ' ' + hashes[operand];
            hashes[i] = kHashed + data::hash_text(data::xxh64(text));
        }
        return hashes[root];
    }

    std::string add(std::string key, std::string text) {
        texts_[key].insert(std::move(text));
        return key;
    }

    const Model& model_;
    /// Texts by key, one each; if two things ever have the same key, both are kept.
    std::map<std::string, std::set<std::string>> texts_;
};

}  // namespace

Reads reads(const Model& model, Index predicate) {
    Reading reading(model);
    reading.add_calibrated(predicate);
    return std::move(reading).take();
}

Reads reads(const Model& model, const Monitor& monitor) {
    Reading reading(model);
    reading.add_monitor(monitor);
    return std::move(reading).take();
}

Reads reads(const Model& model, const Fitted& fitted) {
    Reading reading(model);
    reading.add_fitted(fitted);
    return std::move(reading).take();
}

std::string changed(std::string_view what, std::string_view then, std::string_view now) {
    return fmt::format("{} was: {}; it is: {}", what, then, now);
}

std::vector<std::string> differences(const Reads& then, const Reads& now) {
    std::vector<std::string> found;
    const auto text = [](const Reads& all, const std::string& key) {
        const auto at = all.find(key);
        return at == all.end() ? std::string("none") : at->second;
    };
    Reads both = then;
    both.insert(now.begin(), now.end());
    for (const auto& [key, either] : both) {
        const std::string before = text(then, key);
        const std::string after = text(now, key);
        if (before == after) continue;
        const bool hashed = before[0] == kHashed && after[0] == kHashed;
        found.push_back(hashed ? fmt::format("{} changed", key) : changed(key, before, after));
    }
    return found;
}

}  // namespace etlc::check
