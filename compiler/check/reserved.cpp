#include "check/reserved.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace etlc::check {

namespace {

constexpr std::array kKeywords = std::to_array<std::string_view>({
    "alignas",     "alignof",  "and",        "and_eq",    "asm",       "auto",         "bitand",
    "bitor",       "bool",     "break",      "case",      "catch",     "char",         "char16_t",
    "char32_t",    "char8_t",  "class",      "co_await",  "co_return", "co_yield",     "compl",
    "concept",     "const",    "const_cast", "consteval", "constexpr", "constinit",    "continue",
    "decltype",    "default",  "delete",     "do",        "double",    "dynamic_cast", "else",
    "enum",        "explicit", "export",     "extern",    "false",     "float",        "for",
    "friend",      "goto",     "if",         "inline",    "int",       "long",         "mutable",
    "namespace",   "new",      "noexcept",   "not",       "not_eq",    "nullptr",      "operator",
    "or",          "or_eq",    "private",    "protected", "public",    "register",     "reinterpret_cast",
    "requires",    "return",   "short",      "signed",    "sizeof",    "static",       "static_assert",
    "static_cast", "struct",   "switch",     "template",  "this",      "thread_local", "throw",
    "true",        "try",      "typedef",    "typeid",    "typename",  "typeof",       "union",
    "unsigned",    "using",    "virtual",    "void",      "volatile",  "wchar_t",      "while",
    "xor",         "xor_eq",
});

/// What the generated header says in its own words, wherever a name of the spec could stand before it.
constexpr std::array kGenerated = std::to_array<std::string_view>({
    "Inputs",  "Monitor", "Verdicts",    "etlmon",        "finish",   "int16_t", "int32_t",
    "int64_t", "int8_t",  "kStateBytes", "missing_steps", "ready",    "reset",   "size_t",
    "std",     "step",    "uint16_t",    "uint32_t",      "uint64_t", "uint8_t", "valid",
});

/// Macros of compilers and of the C and POSIX headers. Those in families (FLT_MAX) are in `macro_family`.
constexpr std::array kMacros = std::to_array<std::string_view>({
    "ANDROID", "BUFSIZ",    "DEBUG",     "DOMAIN", "EOF",     "FALSE", "HUGE",     "HUGE_VAL", "HUGE_VALF", "HUGE_VALL",
    "I",       "INFINITY",  "MAXFLOAT",  "NAN",    "NDEBUG",  "NULL",  "OVERFLOW", "PI",       "PLOSS",     "SING",
    "TLOSS",   "TRUE",      "UNDERFLOW", "WIN32",  "alloca",  "arm",   "assert",   "bsd",      "complex",   "errno",
    "i386",    "imaginary", "linux",     "major",  "makedev", "minor", "mips",     "offsetof", "setjmp",    "sgi",
    "sparc",   "stderr",    "stdin",     "stdout", "sun",     "unix",  "vax",
});

/// Functions and types at global scope in the C library and POSIX: no namespace may bear their names.
constexpr std::array kLibrary = std::to_array<std::string_view>({
    "abort",     "abs",      "accept",    "access",    "acos",     "acosh",       "alarm",   "asin",     "asinh",
    "atan",      "atan2",    "atanh",     "atexit",    "atof",     "atoi",        "atol",    "bind",     "brk",
    "bsearch",   "calloc",   "cbrt",      "ceil",      "chdir",    "clearerr",    "clock",   "clock_t",  "close",
    "connect",   "copysign", "cos",       "cosh",      "creat",    "ctime",       "daemon",  "difftime", "div",
    "div_t",     "drem",     "dup",       "erf",       "erfc",     "exit",        "exp",     "exp10",    "exp2",
    "expm1",     "fabs",     "fclose",    "fdim",      "ferror",   "fflush",      "ffs",     "finite",   "floor",
    "fma",       "fmax",     "fmin",      "fmod",      "fopen",    "fork",        "fputs",   "fread",    "free",
    "frexp",     "fsync",    "fwrite",    "gamma",     "getc",     "getenv",      "getline", "gets",     "gmtime",
    "hypot",     "ilogb",    "index",     "ioctl",     "isalpha",  "isdigit",     "isspace", "j0",       "j1",
    "jn",        "kill",     "labs",      "ldexp",     "ldiv",     "lgamma",      "link",    "listen",   "llabs",
    "localtime", "log",      "log10",     "log1p",     "log2",     "logb",        "longjmp", "lrint",    "lround",
    "lseek",     "main",     "malloc",    "memchr",    "memcmp",   "memcpy",      "memmove", "memset",   "mktime",
    "modf",      "nan",      "nearbyint", "nextafter", "nice",     "open",        "optarg",  "pause",    "perror",
    "pid_t",     "pipe",     "poll",      "pow",       "printf",   "putc",        "puts",    "qsort",    "raise",
    "rand",      "random",   "read",      "realloc",   "recv",     "remainder",   "remove",  "rename",   "rewind",
    "rindex",    "rint",     "rmdir",     "round",     "sbrk",     "scalb",       "scanf",   "select",   "send",
    "setenv",    "shutdown", "sigaction", "signal",    "signgam",  "significand", "sin",     "sinh",     "sleep",
    "socket",    "sqrt",     "srand",     "ssize_t",   "stat",     "strcat",      "strchr",  "strcmp",   "strcpy",
    "strlen",    "strstr",   "strtod",    "swab",      "symlink",  "sync",        "system",  "tan",      "tanh",
    "tgamma",    "time",     "time_t",    "times",     "timezone", "tm",          "tmpfile", "tolower",  "toupper",
    "trunc",     "truncate", "ungetc",    "unlink",    "usleep",   "va_list",     "vfork",   "wait",     "write",
    "y0",        "y1",       "yn",
});

// Searched by halves.
static_assert(std::is_sorted(kKeywords.begin(), kKeywords.end()));
static_assert(std::is_sorted(kGenerated.begin(), kGenerated.end()));
static_assert(std::is_sorted(kMacros.begin(), kMacros.end()));
static_assert(std::is_sorted(kLibrary.begin(), kLibrary.end()));

template <std::size_t N>
bool contains(const std::array<std::string_view, N>& table, std::string_view name) {
    return std::binary_search(table.begin(), table.end(), name);
}

/// FLT_MAX, INT8_MIN, M_PI, ...: all capitals behind a prefix of <float.h>, <stdint.h>, <limits.h> or <math.h>.
bool macro_family(std::string_view name) {
    const auto is_capital = [](char c) {
        return std::isupper(static_cast<unsigned char>(c)) || std::isdigit(static_cast<unsigned char>(c)) || c == '_';
    };
    if (!std::all_of(name.begin(), name.end(), is_capital)) return false;
    for (const std::string_view prefix :
         {"FLT_",    "DBL_",     "LDBL_",    "FP_",     "M_",      "INT_",    "UINT_",   "LONG_",
          "ULONG_",  "SHRT_",    "USHRT_",   "CHAR_",   "UCHAR_",  "SCHAR_",  "INT8_",   "INT16_",
          "INT32_",  "INT64_",   "UINT8_",   "UINT16_", "UINT32_", "UINT64_", "INTMAX_", "UINTMAX_",
          "INTPTR_", "UINTPTR_", "PTRDIFF_", "SIZE_",   "WCHAR_",  "WINT_",   "ETLMON_", "RAND_"})
        if (name.starts_with(prefix)) return true;
    return false;
}

bool is_upper(char c) {
    return std::isupper(static_cast<unsigned char>(c)) != 0;
}

std::string without_double_underscores(std::string_view name) {
    std::string result;
    for (const char c : name)
        if (c != '_' || !result.ends_with('_')) result += c;
    result.erase(0, std::min(result.find_first_not_of('_'), result.size()));
    return result;
}

}  // namespace

std::optional<std::string_view> why_forbidden(std::string_view name, bool is_namespace) {
    if (contains(kKeywords, name)) return "is a C++ keyword";
    if (contains(kGenerated, name)) return "is a name that the generated code needs";
    if (contains(kMacros, name) || macro_family(name)) return "is a macro of common C headers or compilers";
    if (name.find("__") != std::string_view::npos) return "has two underscores in a row, which C++ reserves";
    if (name.size() > 1 && name[0] == '_' && is_upper(name[1]))
        return "starts with an underscore and a capital, which C++ reserves";
    if (!is_namespace) return std::nullopt;
    if (name.starts_with('_')) return "starts with an underscore, which C++ reserves at global scope";
    if (contains(kLibrary, name)) return "is a name of the C library, so that no namespace can bear it";
    return std::nullopt;
}

std::string allowed_name(std::string_view name, std::string_view kind, bool is_namespace) {
    std::string result = without_double_underscores(name);
    if (!result.empty() && !std::isdigit(static_cast<unsigned char>(result[0])) && !why_forbidden(result, is_namespace))
        return result;
    while (result.ends_with('_')) result.pop_back();
    if (result.empty() || std::isdigit(static_cast<unsigned char>(result[0])))
        return std::string(kind) + "_" + result + (result.empty() ? "1" : "");
    return result + "_" + std::string(kind);
}

}  // namespace etlc::check
