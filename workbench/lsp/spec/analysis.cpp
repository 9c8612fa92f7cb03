#include "lsp/spec/analysis.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "check/context/context.hpp"
#include "parse/parse.hpp"
#include "recordings/open.hpp"

namespace etlc::lsp {

Analysis::Analysis(std::string path, std::string text, Encoding encoding, check::MatrixCache& cache)
    : file(std::move(path), std::move(text)), lines(file.text(), encoding) {
    spec = parse::parse(file, sink);
    has_syntax_errors = sink.has_errors();
    check::Options options;
    options.open_trace = recordings::open_trace;
    options.allow_missing = true;
    checked =
        std::make_unique<const check::Inspected>(check::inspect(spec, file, options, cache, sink));
}

const Names& Analysis::names() const {
    if (!names_) {
        names_ = names_of(spec, file);
        if (has_syntax_errors) add_uncertain(*names_, parse::words_of(file), file);
    }
    return *names_;
}

Document::Document(std::string uri, std::string text, std::int64_t version, Encoding encoding)
    : uri_(std::move(uri)), text_(std::move(text)), version_(version), encoding_(encoding) {}

void Document::replace(std::string text) {
    text_ = std::move(text);
    forget();
}

void Document::replace(Range range, std::string_view text) {
    if (range.end < range.start) std::swap(range.start, range.end);
    const source::Span span = Lines(text_, encoding_).span(range);
    text_.replace(span.begin, span.end - span.begin, text);
    forget();
}

void Document::forget() {
    planned_.reset();
    analysis_.reset();
    is_news = true;
}

const Analysis& Document::analysis() {
    if (!analysis_)
        analysis_ = std::make_unique<Analysis>(path_of_uri(uri_), text_, encoding_, cache_);
    return *analysis_;
}

void Document::plan() {
    const check::Model& model = analysis().checked->model;
    planned_ = std::make_unique<Planned>();  // where it fails there is no plan, and no second try
    planned_->compiled = compile(model, {}, planned_->sink);
    is_news = is_news || !planned_->sink.sorted().empty();
}

namespace {

using check::NameKind;
using source::Span;

/// Collects the names of a declaration.
class Walk {
public:
    explicit Walk(Names& names) : names_(names) {}

    void use(const ast::Name& name) { use(name.text, name.span); }

    void use(const std::string& name, Span span) {
        if (!name.empty()) names_.occurrences.push_back({name, span});
    }

    /// A constant may follow the sign of a number: it is at its end.
    void visit(const ast::Number& number) {
        if (number.constant.empty()) return;
        const auto size = static_cast<std::uint32_t>(number.constant.size());
        use(number.constant, {number.span.end - size, number.span.end});
    }

    template <class T>
    void visit(const std::optional<T>& optional) {
        if (optional) visit(*optional);
    }
    template <class T>
    void visit(const std::vector<T>& all) {
        for (const T& one : all) visit(one);
    }
    template <class T>
    void visit(const std::unique_ptr<T>& pointer) {
        if (pointer) visit(*pointer);
    }
    template <class... Alternatives>
    void visit(const std::variant<Alternatives...>& value) {
        std::visit([this](const auto& v) { this->visit(v); }, value);
    }

    void visit(const ast::Name& name) { use(name); }
    void visit(const ast::Load& load) { file(load.path, load.path_span); }
    void visit(const ast::Images& images) { file(images.path, images.path_span); }
    void visit(const ast::MatrixLiteral& matrix) { visit(matrix.rows); }
    void visit(const ast::VectorLiteral& vector) { visit(vector.values); }

    void visit(const ast::Frames& frames) {
        file(frames.path, frames.path_span);
        if (!frames.key.empty()) {
            const Span inside{frames.key_span.begin + 1, frames.key_span.end - 1};
            names_.occurrences.push_back({frames.key, inside, false, true});
        }
        visit(frames.frames);
        visit(frames.stride);
    }

    void visit(const ast::Point& point) {
        if (!point.name.text.empty()) visit(point.name);
        visit(point.parts);
        visit(point.factors);
        visit(point.delays);
    }

    void visit(const ast::Fitted& fitted) {
        for (const ast::Fitted::Argument& argument : fitted.arguments) visit(argument.value);
    }

    void visit(const ast::Distance& distance) {
        if (distance.aggregation) visit(distance.aggregation->n);
        visit(distance.weights);
        visit(distance.point);
        visit(distance.other);
    }

    void visit(const ast::Expr& expression) {
        if (expression.kind == ast::Expr::Kind::name) use(expression.text, expression.span);
        visit(expression.distance);
        visit(expression.arguments);
        if (!expression.past) return;
        visit(expression.past->formula);
        visit(expression.past->time);
    }

    void visit(const ast::Bound& bound) {
        if (bound.calibrated) return visit(*bound.calibrated);
        visit(bound.number);
    }

    void visit(const ast::Formula& formula) {
        if (formula.kind == ast::Formula::Kind::name) use(formula.name, formula.span);
        visit(formula.operands);
        if (formula.interval) {
            visit(formula.interval->low);
            // held[D] has one bound.
            if (formula.kind != ast::Formula::Kind::held ||
                formula.interval->high.span.begin != formula.interval->low.span.begin)
                visit(formula.interval->high);
        }
        visit(formula.left);
        visit(formula.right);
    }

    void visit(const ast::Calibrated& calibrated) {
        for (const ast::Calibrated::Argument& argument : calibrated.arguments)
            if (argument.key.text != "against") visit(argument.value);
    }

    void visit(const ast::Encoder& encoder) {
        visit(encoder.model);
        for (const ast::Encoder::Setting& setting : encoder.settings) visit(setting.values);
    }

    void visit(const ast::Constant& /*constant*/) {}
    void visit(const ast::Rate& rate) { visit(rate.number); }

    void visit(const ast::Input& input) {
        visit(input.type.dimension);
        visit(input.type.scale);
        visit(input.encoder);
        if (input.range) {
            visit(input.range->low);
            visit(input.range->high);
        }
        visit(input.hold);
        visit(input.stale);
    }

    void visit(const ast::Projection& projection) {
        visit(projection.matrix);
        visit(projection.offset);
    }

    void visit(const ast::Target& target) {
        visit(target.sources);
        visit(target.encoder);
        visit(target.space);
    }

    void visit(const ast::Predicate& predicate) {
        visit(predicate.expression);
        visit(predicate.threshold);
    }

    void visit(const ast::Truth& truth) {
        use(truth.subject);
        visit(truth.formula);
    }
    void visit(const ast::Let& let) { visit(let.formula); }
    void visit(const ast::Monitor& monitor) {
        visit(monitor.formula);
        visit(monitor.calibrated);
    }
    void visit(const ast::Drift& drift) {
        use(drift.of);
        for (const ast::Calibrated::Argument& argument : drift.arguments) visit(argument.value);
    }

private:
    void file(const std::string& path, Span span) { names_.files.push_back({path, span}); }

    Names& names_;
};

Shape shape_of(const ast::Type& type) {
    if (type.kind == ast::Type::Kind::boolean) return Shape::boolean;
    return type.dimension ? Shape::embedding : Shape::scalar;
}

void declare(Names& names, std::optional<NameKind> kind, const ast::Name& name, Span span,
             const ast::Declaration* declaration) {
    if (name.text.empty()) return;
    names.occurrences.push_back({name.text, name.span, true, false, false, !kind});
    Declared declared{name.text, kind, name.span, span};
    if (declaration != nullptr) {
        if (const auto* input = std::get_if<ast::Input>(declaration))
            declared.shape = shape_of(input->type);
        if (const auto* constant = std::get_if<ast::Constant>(declaration))
            declared.is_duration = !constant->unit.empty();
    }
    names.declared.push_back(std::move(declared));
}

void sort(Names& names) {
    std::stable_sort(
        names.occurrences.begin(), names.occurrences.end(),
        [](const Occurrence& a, const Occurrence& b) { return a.span.begin < b.span.begin; });
}

}  // namespace

Names names_of(const ast::Spec& spec, const source::File& file) {
    Names names;
    const std::string_view text = file.text();
    if (!spec.name.text.empty()) {
        const std::size_t begin = text.rfind("spec", spec.name.span.begin - 1);
        const std::size_t end = std::min(text.size() - 1, text.find(';', spec.name.span.end));
        const Span whole{static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end + 1)};
        declare(names, std::nullopt, spec.name, whole, nullptr);
        names.readable.push_back(whole);
    }
    for (const ast::Declaration& declaration : spec.declarations) {
        const Span span = std::visit([](const auto& d) { return d.span; }, declaration);
        names.readable.push_back(span);
        check::for_each_name(declaration, [&](NameKind kind, const ast::Name& name) {
            declare(names, kind, name, span, &declaration);
        });
        Walk(names).visit(declaration);
    }
    for (const ast::Name& name : spec.unreadable)
        if (name.text != "rate") declare(names, NameKind::unreadable, name, name.span, nullptr);
    std::stable_sort(
        names.declared.begin(), names.declared.end(),
        [](const Declared& a, const Declared& b) { return a.name_span.begin < b.name_span.begin; });
    std::stable_sort(names.readable.begin(), names.readable.end(),
                     [](Span a, Span b) { return a.begin < b.begin; });
    sort(names);
    return names;
}

void add_uncertain(Names& names, const std::vector<parse::Word>& words, const source::File& file) {
    std::set<std::string_view> known;
    for (const Declared& declared : names.declared)
        if (declared.kind) known.insert(declared.name);
    std::set<std::uint32_t> seen;
    for (const Occurrence& occurrence : names.occurrences) seen.insert(occurrence.span.begin);
    std::vector<Occurrence> found;
    auto readable = names.readable.begin();
    for (const parse::Word& word : words) {
        while (readable != names.readable.end() && readable->end <= word.span.begin) ++readable;
        if (readable != names.readable.end() && readable->begin <= word.span.begin) continue;
        const bool is_name =
            word.kind == parse::Word::Kind::name || word.kind == parse::Word::Kind::contextual;
        const std::string_view text = file.text(word.span);
        if (is_name && known.contains(text) && !seen.contains(word.span.begin))
            found.push_back({std::string(text), word.span, false, false, true});
    }
    names.occurrences.insert(names.occurrences.end(), found.begin(), found.end());
    sort(names);
}

const Occurrence* occurrence_at(const Names& names, std::uint32_t offset) {
    for (const Occurrence& occurrence : names.occurrences)
        if (occurrence.span.begin <= offset && offset <= occurrence.span.end) return &occurrence;
    return nullptr;
}

const Declared* declaration_of(const Names& names, const Occurrence& occurrence) {
    for (const Declared& declared : names.declared)
        if (declared.name == occurrence.name && !declared.kind == occurrence.of_spec)
            return &declared;
    return nullptr;
}

}  // namespace etlc::lsp
