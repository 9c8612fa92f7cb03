// Names that a spec may not declare because of C++ or the generated code. An accepted name compiles
// as a field and, followed by _ or by _ and words, as any other name in the generated class; an
// accepted namespace does not clash with C headers.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace etlc::check {

/// Returns why `name` cannot be declared: "is a C++ keyword". `is_namespace`: it names a namespace
/// at global scope, as the spec's own name does, beside the functions of the C library.
std::optional<std::string_view> why_forbidden(std::string_view name, bool is_namespace);

/// Returns the header that defines `name` as a macro for something else, as <windows.h> defines
/// near as nothing. Such a name may be declared; generated code protects its own uses.
std::optional<std::string_view> macro_elsewhere(std::string_view name);

/// Returns a similar name that may be declared: `int_input` for `int`, `a_b` for `a__b`. `kind` is
/// a word of the language.
std::string allowed_name(std::string_view name, std::string_view kind, bool is_namespace);

}  // namespace etlc::check
