#include "random_spec.hpp"

#include <fmt/format.h>

#include <map>
#include <string>
#include <vector>

#include "random.hpp"
#include "random_formula.hpp"

namespace etlc::tests {
namespace {

/// The declarations that formulas use.
class Declarations {
public:
    Declarations(Random& random, const SpecShape& shape)
        : random_(random), exact_(shape.exact), missing_share_(shape.missing) {}

    std::string text() {
        std::string result = fmt::format("const c = {};\n", number(-3, 3));
        for (const char* name : {"x", "y"}) result += scalar(name);
        result += fmt::format("input on : bool{}{};\n", hold(), missing());
        dimension_ = random_.between(1, 5);
        for (const char* name : {"v", "w"})
            result += fmt::format("input {} : {}{}{};\n", name, embedding(), hold(), stale());
        for (const char* name : {"near", "far"}) result += target(name, dimension_);
        result += target("spots", 2);
        result += projections();
        result += target("own", projected_, " of P(v)");
        result += target("shared", projected_, " of head(v)");
        const int count = random_.between(4, 6);
        for (int n = 0; n < count; ++n) {
            atoms_.push_back(fmt::format("p{}", n));
            result += fmt::format("predicate p{} = {}{};\n", n, predicate(), missing());
        }
        atoms_.emplace_back("on");
        return result;
    }

    const std::vector<std::string>& atoms() const { return atoms_; }

    /// Returns a comparison within a formula.
    std::string comparison() {
        if (random_.chance(0.3)) return comparison_of_scalars();
        return fmt::format("{} {} {}", expression(1), compare(), cut());
    }

private:
    Random& random_;
    bool exact_;
    double missing_share_;
    /// Writes an operand of a difference: a large number would round by more than the difference
    /// may be off.
    bool in_difference_ = false;
    int dimension_ = 1;
    int projected_ = 1;                ///< of P(v)
    std::map<std::string, int> rows_;  // of each target
    std::vector<std::string> atoms_;

    std::string hold() {
        return random_.chance(0.3) ? fmt::format(" hold {}", random_.between(1, 3)) : "";
    }
    std::string stale() {
        return random_.chance(0.2) ? fmt::format(", stale after {}", random_.between(1, 3)) : "";
    }
    std::string missing() {
        if (missing_share_ == 0 || !random_.chance(missing_share_)) return "";
        return random_.chance(0.5) ? " missing true" : " missing false";
    }
    std::string number(int low, int high) {
        return fmt::format("{}", random_.grid(low, high, 0.25));
    }
    /// Returns a number to compare scalars with. Sometimes no sample reaches it, so that the
    /// declared range decides the comparison.
    std::string cut() { return random_.chance(0.2) ? number(-6, 6) : number(-3, 3); }
    std::string compare() { return random_.word({"<=", "<", ">=", ">"}); }

    /// An order or equality of exact values: inputs, numbers and a constant, on either side.
    std::string comparison_of_scalars() {
        const auto side = [this] { return random_.chance(0.3) ? "c" : cut(); };
        const std::string op = random_.chance(0.5) ? random_.word({"==", "!="}) : compare();
        const std::string input = random_.word({"x", "y", "x@2", "max(y, 2 steps)"});
        if (random_.chance(0.3)) return fmt::format("x {} y", op);
        if (random_.chance(0.3)) return fmt::format("{} {} {}", side(), op, input);
        return fmt::format("{} {} {}", input, op, side());
    }

    std::string scalar(const char* name) {
        const char* range = random_.chance(0.6)   ? " in [-4, 4]"
                            : random_.chance(0.3) ? " in [-3.5, inf]"
                                                  : "";
        return fmt::format("input {} : f32{}{}{};\n", name, range, hold(), stale());
    }

    std::string embedding() {
        const int kind = random_.between(0, 3);
        if (kind == 0) return fmt::format("f16[{}]", dimension_);
        if (kind == 1) return fmt::format("i8[{}] scale 0.25", dimension_);
        return fmt::format("f32[{}]", dimension_);
    }

    std::string matrix(int rows, int columns, double grid) {
        std::string text;
        for (int row = 0; row < rows; ++row) {
            std::string values;
            for (int n = 0; n < columns; ++n)
                values += fmt::format("{}{}", n > 0 ? ", " : "", random_.grid(-1, 1, grid));
            text += fmt::format("{}[{}]", row > 0 ? ", " : "", values);
        }
        return fmt::format("[{}]", text);
    }

    std::string projection(const char* name, int rows, int columns, double grid,
                           bool shared = false) {
        const std::string offset =
            random_.chance(0.5) ? fmt::format(" offset {}", matrix(1, columns, 0.25)) : "";
        return fmt::format("projection {} = {}{}{};\n", name, matrix(rows, columns, grid), offset,
                           shared ? " in actions" : "");
    }

    /// Few binary digits: a sum of squares of Q(P(v)) must be exact in float32.
    std::string projections() {
        projected_ = random_.between(1, 3);
        return projection("P", projected_, dimension_, 0.25) + projection("Q", 2, projected_, 1) +
               projection("T", 1, 2, 0.25) +
               projection("head", projected_, dimension_, 0.25, true) +
               projection("tail", projected_, dimension_, 0.25, true);
    }

    /// 1, 2 or 4 rows, so that their mean is exact.
    std::string target(const char* name, int columns, const char* space = "") {
        std::string rows;
        const int count = 1 << random_.between(0, 2);
        rows_[name] = count;
        for (int row = 0; row < count; ++row) {
            std::string values;
            // A row must not be zero under cosine and angular, so the first element is not.
            for (int n = 0; n < columns; ++n)
                values += (n > 0 ? ", " : "") + (n > 0 ? number(-3, 3) : number(1, 3));
            rows += fmt::format("{}[{}]", row > 0 ? ", " : "", values);
        }
        return fmt::format("target {} = [{}]{};\n", name, rows, space);
    }

    std::string weights(int columns) {
        std::string rows;
        const bool diagonal = random_.chance(0.5);
        for (int row = 0; row < columns; ++row) {
            if (diagonal) {
                rows += (row > 0 ? ", " : "") + number(1, 4);
                continue;
            }
            std::string values;  // symmetric and diagonally dominant
            for (int n = 0; n < columns; ++n)
                values += (n > 0 ? ", " : "") + std::string(n == row             ? "2"
                                                            : (n + row) % 2 == 0 ? "0.25"
                                                                                 : "-0.25");
            rows += fmt::format("{}[{}]", row > 0 ? ", " : "", values);
        }
        return fmt::format("mahalanobis([{}])", rows);
    }

    std::string metric(int columns) {
        if (exact_) return random_.word({"l1", "linf", "l2sq"});
        if (in_difference_) return random_.word({"linf", "l2", "cosine", "angular"});
        const std::string name =
            random_.word({"l1", "linf", "l2sq", "l2", "l2", "cosine", "angular", "mahalanobis"});
        return name == "mahalanobis" ? weights(columns) : name;
    }

    std::string aggregation(const std::string& target) {
        const std::string word = random_.word({"min", "min", "max", "mean", "kth"});
        return word == "kth" ? fmt::format("kth({})", random_.between(1, rows_[target])) : word;
    }

    /// Between points that may be zero.
    std::string metric_of_any(int columns) {
        if (exact_) return metric(columns);
        if (in_difference_) return random_.word({"linf", "l2"});
        const std::string name = random_.word({"l1", "linf", "l2sq", "l2", "mahalanobis"});
        return name == "mahalanobis" ? weights(columns) : name;
    }

    std::string ago() { return fmt::format("@{}", random_.between(1, 4)); }

    /// An embedding as it is or was, also before it was delayed again.
    std::string embedded() {
        const std::string name = random_.word({"v", "v", "w"});
        if (random_.chance(0.5)) return name;
        return random_.chance(0.2) ? name + ago() + ago() : name + ago();
    }

    /// A point in the space of the embeddings, or in that of `head`.
    std::string in_space(bool actions) {
        if (!actions) return embedded();
        return fmt::format("{}({}){}", random_.word({"head", "tail"}), embedded(),
                           random_.chance(0.3) ? ago() : "");
    }

    /// Few binary digits, as in a matrix.
    std::string sum(bool actions) {
        std::string text = random_.chance(0.2) ? "-" : "";
        for (int n = random_.between(1, 3); n >= 0; --n) {
            if (random_.chance(0.4)) text += random_.word({"2 * ", "0.5 * ", "1.5 * "});
            text += random_.chance(0.15)
                        ? fmt::format("({} - {}){}", in_space(actions), in_space(actions), ago())
                        : in_space(actions);
            if (n > 0) text += random_.word({" - ", " + "});
        }
        return text;
    }

    /// Squares of sums do not fit into float32.
    std::string metric_of_sum(int columns) {
        return exact_ ? random_.word({"l1", "linf"}) : metric_of_any(columns);
    }

    /// A sum of points, and what it is compared with.
    std::string distance_of_sum() {
        const bool actions = random_.chance(0.4);
        const int columns = actions ? projected_ : dimension_;
        const std::string target = actions ? "shared" : random_.word({"near", "far"});
        switch (random_.between(0, 4)) {
            case 0:
                return fmt::format("{}({}, {})", metric_of_sum(columns), sum(actions),
                                   in_space(actions));
            case 1:
                return fmt::format("{}({}, {})", metric_of_sum(columns), sum(actions),
                                   sum(actions));
            case 2:
                return fmt::format("{} {}(P({}), near)", aggregation("near"),
                                   metric_of_sum(projected_), sum(false));
            case 3:
                return fmt::format("{}([{}, x], [{}, y{}])", metric_of_sum(columns + 1),
                                   sum(actions), in_space(actions), ago());
            default:
                return fmt::format("{} {}({}, {})", aggregation(target), metric_of_sum(columns),
                                   sum(actions), target);
        }
    }

    /// Two points of the same space, now or a while ago.
    std::string between_points() {
        const std::string either = random_.chance(0.5) ? ago() : "";
        switch (random_.between(0, 4)) {
            case 0: return fmt::format("{}([x, y], [y, x]{})", metric(2), ago());
            case 1: return fmt::format("{}([x, y@2]{}, [y, x{}])", metric(2), either, ago());
            case 2:
                return fmt::format("{}(P({}){}, P(w{}))", metric_of_any(projected_), embedded(),
                                   either, ago());
            case 3:
                return fmt::format("{}([v, x, v{}]{}, [{}, y, w])", metric(2 * dimension_ + 1),
                                   ago(), either, embedded());
            default: return fmt::format("{}({}, {})", metric(dimension_), embedded(), embedded());
        }
    }

    /// A target set as seen from a point of a while ago, or from several points.
    std::string past_distance() {
        const std::string target = random_.word({"near", "far"});
        switch (random_.between(0, 3)) {
            case 0:
                return fmt::format("{} {}(P(v{}){}, own)", aggregation("own"),
                                   metric_of_any(projected_), ago(), ago());
            case 1:
                return fmt::format("{} {}(Q(P(v){}), {})", aggregation(target), metric_of_any(2),
                                   ago(), target);
            case 2:
                return fmt::format("{} {}([x, x{}], spots)", aggregation("spots"), metric(2),
                                   ago());
            default:
                return fmt::format("{} {}({}, {})", aggregation(target), metric(dimension_),
                                   embedded(), target);
        }
    }

    std::string projected_distance() {
        if (random_.chance(0.3))
            return fmt::format("{} {}(P(v), own)", aggregation("own"), metric(projected_));
        if (random_.chance(0.3))
            return fmt::format("{} {}(T([x, y]), spots)", aggregation("spots"), metric_of_any(1));
        const std::string target = random_.word({"near", "far", "own"});
        if (random_.chance(0.5))
            return fmt::format("{} {}(Q(P(v)), {})", aggregation(target), metric_of_any(2), target);
        return fmt::format("{} {}(P(v), {})", aggregation(target), metric_of_any(projected_),
                           target);
    }

    std::string distance() {
        if (random_.chance(0.25)) return between_points();
        if (random_.chance(0.25)) return distance_of_sum();
        if (random_.chance(0.15)) return past_distance();
        if (random_.chance(0.3)) return projected_distance();
        if (random_.chance(0.3))
            return fmt::format("{} {}([x, y], spots)", aggregation("spots"), metric(2));
        const std::string target = random_.word({"near", "far"});
        return fmt::format("{} {}(v, {})", aggregation(target), metric(dimension_), target);
    }

    /// A number that earlier steps have a part in. A mean of 2 or 4 is exact.
    std::string past(const std::string& of) {
        const int steps = random_.between(1, 4);
        switch (random_.between(0, 3)) {
            case 0: return fmt::format("({})@{}", of, steps);
            case 1: return fmt::format("mean({}, {} steps)", of, !exact_ || steps != 3 ? steps : 2);
            case 2: return fmt::format("min({}, {} steps)", of, steps + 1);
            default: return fmt::format("max({}, {} steps)", of, steps + 1);
        }
    }

    std::string scalar_term() {
        if (random_.chance(0.2)) return past(scalar_term());
        if (random_.chance(0.3)) return random_.word({"x", "y"});
        switch (random_.between(0, exact_ ? 5 : 7)) {
            case 0: return fmt::format("{} * {}", number(-2, 2), random_.word({"x", "y"}));
            case 1: return "abs(x - y)";
            case 2: return fmt::format("max(x, y, {})", number(-2, 2));
            case 3: return "min(x, -y)";
            case 4: return "(x + y) / 2";
            case 5: return "-x";
            case 6: return "sqrt(abs(y))";
            default: return "x / (abs(y) + 0.5)";
        }
    }

    std::string expression(int terms) {
        std::string result = scalar_term();
        for (int n = 1; n < terms; ++n) result += random_.word({" + ", " - "}) + scalar_term();
        return result;
    }

    std::string difference(bool of_past) {
        in_difference_ = true;
        const std::string result = of_past ? fmt::format("{} - {}", past(distance()),
                                                         random_.chance(0.5) ? "y" : distance())
                                           : fmt::format("{} - {}", distance(), distance());
        in_difference_ = false;
        return result;
    }

    std::string predicate() {
        const int kind = random_.between(0, 10);
        if (kind == 10) return comparison_of_scalars();
        if (kind < 5) return fmt::format("{} {} {}", distance(), compare(), number(0, 6));
        if (kind < 7)
            return fmt::format("{} {} {}", difference(kind == 6), compare(), number(-2, 2));
        return fmt::format("{} {} {}", expression(random_.between(1, 3)), compare(), cut());
    }
};

FormulaShape formula_shape(const SpecShape& shape, bool sliding) {
    using Formulas = SpecShape::Formulas;
    FormulaShape result;
    result.depth = shape.depth;
    result.window = shape.window;
    result.nested = shape.formulas != Formulas::unnested;
    result.bounded = shape.formulas != Formulas::unbounded_nesting;
    result.unbounded = !sliding;
    result.past_over_future = sliding;
    result.future = shape.future;
    result.timed = shape.formulas == Formulas::sequences;
    if (shape.formulas == Formulas::chains || result.timed) result.phases = shape.depth;
    return result;
}

/// Returns another number for other shapes, so that they have other predicates, too.
std::uint64_t seed_of(std::uint64_t seed, const SpecShape& shape) {
    std::uint64_t result = static_cast<std::uint64_t>(shape.formulas);
    for (const int part : {shape.monitors, shape.depth, shape.window, shape.exact ? 1 : 0,
                           shape.restarts > 0 ? 1 : 0, shape.missing > 0 ? 1 : 0})
        result = 64 * result + static_cast<std::uint64_t>(part);
    return seed + (result << 20U);
}

}  // namespace

std::string random_spec(std::uint64_t seed, const SpecShape& shape) {
    Random random(seed_of(seed, shape));
    Declarations declarations(random, shape);
    std::string result = fmt::format("spec random_{};\n", seed) + declarations.text();
    const auto comparison = [&] { return declarations.comparison(); };
    RandomFormula prefix(random, declarations.atoms(), comparison, formula_shape(shape, false));
    RandomFormula sliding(random, declarations.atoms(), comparison, formula_shape(shape, true),
                          "sliding_part");
    for (int n = 0; n < shape.monitors; ++n) {
        const bool slides = shape.formulas == SpecShape::Formulas::sliding ||
                            (shape.formulas == SpecShape::Formulas::mixed && n % 2 == 1);
        RandomFormula& formula = slides ? sliding : prefix;
        const bool restarts = !slides && shape.restarts > 0 && random.chance(shape.restarts);
        const std::string kind = slides      ? "sliding "
                                 : !restarts ? ""
                                             : random.word({"restartable ", "repeating "});
        std::string text = formula.make();
        result += formula.take_lets();
        if (slides) {  // under a separate name, since the output of a let is compared with this one
            result += fmt::format("let said{} = {};\n", n, text);
            text = fmt::format("said{}", n);
        }
        result += fmt::format("{}monitor m{} = {};\n", kind, n, text);
    }
    return result;
}

}  // namespace etlc::tests
