// Parses a text in tests: its tree and its diagnostics.
#pragma once

#include <string>

#include "diag/diag.hpp"
#include "parse/parse.hpp"
#include "tree_text.hpp"

namespace etlc {

struct Parsed {
    source::File file;
    diag::Sink sink;
    ast::Spec spec;

    explicit Parsed(std::string text)
        : file("a.etl", std::move(text)), spec(parse::parse(file, sink)) {}

    std::string tree() const { return tree_text::of(spec); }
    std::string errors() const { return diag::render_text(file, sink); }
    /// Returns "E0104 2:9 message; ..." for all diagnostics.
    std::string brief() const {
        std::string result;
        for (const diag::Diagnostic& d : sink.sorted()) {
            const source::Position at =
                d.span ? file.position(d.span->begin) : source::Position{0, 0};
            result += std::string(diag::info(d.code).code) + " " + std::to_string(at.line) + ":" +
                      std::to_string(at.column) + " " + d.message + "\n";
        }
        return result;
    }
};

/// Returns the tree of one formula, or its errors.
inline std::string tree_of_formula(const std::string& formula) {
    const Parsed parsed("spec a; let f = " + formula + ";");
    if (parsed.sink.has_errors()) return parsed.errors();
    return tree_text::of(*std::get<ast::Let>(parsed.spec.declarations.at(0)).formula);
}

/// Returns the tree of one declaration, or its errors.
inline std::string tree_of_declaration(const std::string& declaration) {
    const Parsed parsed("spec a; " + declaration);
    if (parsed.sink.has_errors()) return parsed.errors();
    return tree_text::of(parsed.spec.declarations.at(0));
}

/// Returns the tree of one expression, or its errors.
inline std::string tree_of_expression(const std::string& expression) {
    const Parsed parsed("spec a; predicate p = " + expression + " < 1;");
    if (parsed.sink.has_errors()) return parsed.errors();
    return tree_text::of(*std::get<ast::Predicate>(parsed.spec.declarations.at(0)).expression);
}

}  // namespace etlc
