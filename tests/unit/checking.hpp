// Checks a text in tests: its model and its diagnostics.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>

#include "check/check.hpp"
#include "diag/diag.hpp"
#include "parse/parse.hpp"

namespace etlc {

struct Checked {
    source::File file;
    diag::Sink sink;
    ast::Spec spec;
    std::optional<check::Model> model;

    explicit Checked(std::string text, const check::Options& options = {},
                     std::string path = "t.etl")
        : file(std::move(path), std::move(text)),
          spec(parse::parse(file, sink)),
          model(check::check(std::move(spec), file, options, sink)) {}

    std::string diagnostics() const { return diag::render_text(file, sink); }
    /// Returns "E0204 W0201": the codes of all diagnostics, in the order of their places.
    std::string codes() const {
        std::string result;
        for (const diag::Diagnostic& d : sink.sorted()) {
            if (!result.empty()) result += ' ';
            result += diag::info(d.code).code;
        }
        return result;
    }
    const check::Predicate& predicate(const std::string& name) const {
        for (const check::Predicate& p : model->predicates)
            if (p.name == name) return p;
        throw std::runtime_error("no predicate " + name);
    }
    const check::Monitor& monitor(const std::string& name) const {
        for (const check::Monitor& m : model->monitors)
            if (m.name == name) return m;
        throw std::runtime_error("no monitor " + name);
    }
    /// Returns the monitor's formula in canonical text.
    std::string formula(const std::string& name) const {
        return check::print(*model, monitor(name).formula);
    }
};

}  // namespace etlc
