// First step: which names there are, and whether they can be borne.
#include <fmt/format.h>

#include "check/context/steps.hpp"
#include "check/names/reserved.hpp"

namespace etlc::check {

namespace {

using diag::Code;

void suggest(Context& c, diag::Diagnostic& to, std::string suggestion, bool is_namespace) {
    while (!is_namespace && c.scope.find(suggestion) != nullptr) suggestion += "1";
    to.note(fmt::format("another name would do, for example '{}'", suggestion)).meant = suggestion;
}

void check_spelling(Context& c, const ast::Name& name, std::string_view kind, bool is_namespace) {
    if (name.text.empty()) return;
    if (const auto why = why_forbidden(name.text, is_namespace)) {
        auto& error =
            c.report(Code::forbidden_name, name.span, fmt::format("'{}' {}", name.text, *why));
        return suggest(c, error, allowed_name(name.text, kind, is_namespace), is_namespace);
    }
    // Programs write these names; all others stand in generated code alone.
    const bool is_written = kind == "spec" || kind == "input" || kind == "monitor";
    const auto header = macro_elsewhere(name.text);
    if (!header || !is_written) return;
    auto& warning =
        c.report(Code::macro_elsewhere, name.span,
                 fmt::format("'{}' is a macro of {}: a program that includes that cannot write it",
                             name.text, *header));
    suggest(c, warning, fmt::format("{}_{}", name.text, kind), is_namespace);
}

void declare(Context& c, NameKind kind, const ast::Name& name) {
    if (name.text.empty()) {
        c.scope.declare(kind, name);
        return;
    }
    const Entity* first = c.scope.declare(kind, name);
    if (first == nullptr) return;
    c.report(Code::duplicate_name, name.span, fmt::format("'{}' is declared twice", name.text))
        .note(first->span, fmt::format("'{}' is declared here first", name.text));
}

void declare_all(Context& c) {
    for (const ast::Declaration& declaration : c.spec.declarations) {
        for_each_name(declaration,
                      [&](NameKind kind, const ast::Name& name) { declare(c, kind, name); });
    }
    for (const ast::Name& name : c.spec.unreadable)
        if (c.scope.find(name.text) == nullptr) c.scope.declare(NameKind::unreadable, name);
}

}  // namespace

void declare_names(Context& c) {
    declare_all(c);
    c.model.name = c.spec.name.text;
    check_spelling(c, c.spec.name, "spec", true);
    for (const NameKind kind :
         {NameKind::constant, NameKind::encoder, NameKind::input, NameKind::projection,
          NameKind::target, NameKind::predicate, NameKind::let, NameKind::monitor})
        for (const Entity& entity : c.scope.all(kind))
            if (!entity.duplicate) check_spelling(c, {entity.name, entity.span}, word(kind), false);
    if (c.scope.all(NameKind::monitor).empty() && !c.incomplete)
        c.report(Code::no_monitor, c.spec.name.span,
                 "the spec has no monitor, so there is nothing to compile")
            .note("add a line such as 'monitor m = G p;'");
}

}  // namespace etlc::check
