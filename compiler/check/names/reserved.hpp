// Names that a spec may not declare, because C++ or the generated code could not bear them.
// Takes: a name and what it would name. Gives: why not, or nothing.
// Keeps true: a name that passes compiles as a field, and followed by _ or by _ and words as any
// other name in the generated class; one that passes as a namespace also stands beside everything
// that the C headers declare.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace etlc::check {

/// Why no declaration may bear `name`: "is a C++ keyword". `is_namespace` for a namespace at global
/// scope, the spec's own name, which stands beside the functions of the C library.
std::optional<std::string_view> why_forbidden(std::string_view name, bool is_namespace);

/// The header, in words, of which `name` is a macro that stands for something else: near is nothing
/// at all in <windows.h>. Such a name may be declared, and generated code shields its own.
std::optional<std::string_view> macro_elsewhere(std::string_view name);

/// A name like `name` that may be declared: `int` becomes `int_input`, `a__b` becomes `a_b`. `kind`
/// is a word of the language.
std::string allowed_name(std::string_view name, std::string_view kind, bool is_namespace);

}  // namespace etlc::check
