#include "ast/ast.hpp"

namespace etlc::ast {

namespace {

/// Moves the spans of whatever it is applied to.
class Shift {
public:
    explicit Shift(std::int64_t bytes) : bytes_(bytes) {}

    template <class... Parts>
    void all(Parts&... parts) const {
        (move(parts), ...);
    }

private:
    void move(Span& span) const {
        if (span.end == 0) return;  // of something that is not written
        span.begin = static_cast<std::uint32_t>(span.begin + bytes_);
        span.end = static_cast<std::uint32_t>(span.end + bytes_);
    }

    template <class T>
    void move(std::vector<T>& parts) const {
        for (T& part : parts) move(part);
    }
    template <class T>
    void move(std::optional<T>& part) const {
        if (part) move(*part);
    }
    template <class T>
    void move(Owned<T>& part) const {
        if (part) move(*part);
    }
    template <class... Alternatives>
    void move(std::variant<Alternatives...>& part) const {
        std::visit([this](auto& one) { this->move(one); }, part);
    }

    void move(Name& x) const { all(x.span); }
    void move(Number& x) const { all(x.span); }
    void move(MatrixLiteral& x) const { all(x.rows, x.span); }
    void move(VectorLiteral& x) const { all(x.values, x.span); }
    void move(Load& x) const { all(x.path_span, x.key_span, x.span); }
    void move(Frames& x) const {
        all(x.frames, x.stride, x.path_span, x.key_span, x.frames_span, x.span);
    }
    void move(Images& x) const { all(x.path_span, x.span); }
    void move(Bound& x) const { all(x.number, x.span); }
    void move(Point& x) const { all(x.name, x.parts, x.delays, x.span); }
    void move(Fitted::Argument& x) const { all(x.key, x.value); }
    void move(Fitted& x) const { all(x.method, x.arguments, x.span); }
    void move(Aggregation& x) const { all(x.n, x.span); }
    void move(Distance& x) const {
        all(x.aggregation, x.metric, x.weights, x.point, x.other, x.span);
    }
    void move(Past& x) const { all(x.formula, x.time); }
    void move(Expr& x) const { all(x.distance, x.past, x.arguments, x.span); }
    void move(Interval& x) const { all(x.low, x.high, x.span); }
    void move(Formula& x) const {
        all(x.operands, x.interval, x.left, x.right, x.operator_span, x.span);
    }
    void move(Rate& x) const { all(x.number, x.span); }
    void move(Constant& x) const { all(x.name, x.value, x.span); }
    void move(Type& x) const { all(x.dimension, x.scale, x.span); }
    void move(Range& x) const { all(x.low, x.high, x.span); }
    void move(Encoder::Setting& x) const { all(x.key, x.word, x.values, x.file, x.span); }
    void move(Encoder& x) const { all(x.name, x.model, x.settings, x.span); }
    void move(Input& x) const { all(x.names, x.type, x.encoder, x.range, x.hold, x.stale, x.span); }
    void move(Projection& x) const { all(x.name, x.matrix, x.offset, x.span); }
    void move(Target& x) const { all(x.name, x.sources, x.encoder, x.space, x.span); }
    void move(Calibrated::Argument& x) const { all(x.key, x.value); }
    void move(Calibrated& x) const { all(x.method, x.arguments, x.span); }
    void move(Predicate& x) const { all(x.name, x.expression, x.threshold, x.span); }
    void move(Truth& x) const { all(x.subject, x.formula, x.span); }
    void move(Let& x) const { all(x.name, x.formula, x.span); }
    void move(Monitor& x) const { all(x.name, x.formula, x.calibrated, x.span); }

    std::int64_t bytes_;
};

}  // namespace

void shift(Declaration& declaration, std::int64_t bytes) {
    Shift(bytes).all(declaration);
}

void shift(Name& name, std::int64_t bytes) {
    Shift(bytes).all(name);
}

}  // namespace etlc::ast
