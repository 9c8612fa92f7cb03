#include "check/names/reserved.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

namespace etlc::check {

namespace {

constexpr std::array kKeywords = std::to_array<std::string_view>({
    // clang-format off
    "alignas", "alignof", "and", "and_eq", "asm", "auto", "bitand", "bitor", "bool", "break",
    "case", "catch", "char", "char16_t", "char32_t", "char8_t", "class", "co_await", "co_return",
    "co_yield", "compl", "concept", "const", "const_cast", "consteval", "constexpr", "constinit",
    "continue", "decltype", "default", "delete", "do", "double", "dynamic_cast", "else", "enum",
    "explicit", "export", "extern", "false", "float", "for", "friend", "goto", "if", "inline",
    "int", "long", "mutable", "namespace", "new", "noexcept", "not", "not_eq", "nullptr",
    "operator", "or", "or_eq", "private", "protected", "public", "register", "reinterpret_cast",
    "requires", "return", "short", "signed", "sizeof", "static", "static_assert", "static_cast",
    "struct", "switch", "template", "this", "thread_local", "throw", "true", "try", "typedef",
    "typeid", "typename", "typeof", "union", "unsigned", "using", "virtual", "void", "volatile",
    "wchar_t", "while", "xor", "xor_eq",
    // clang-format on
});

/// Names used in the fields of generated structs.
constexpr std::array kGenerated =
    std::to_array<std::string_view>({"etlmon", "int16_t", "int32_t", "int64_t", "int8_t", "size_t",
                                     "std", "uint16_t", "uint32_t", "uint64_t", "uint8_t"});

/// Macros of compilers and of C and POSIX headers that are not in capitals.
constexpr std::array kMacros = std::to_array<std::string_view>({
    // clang-format off
    "AF_DECnet", "B0", "B1000000", "B110", "B115200", "B1152000", "B1200", "B134", "B150",
    "B1500000", "B1800", "B19200", "B200", "B2000000", "B230400", "B2400", "B2500000", "B300",
    "B3000000", "B3500000", "B38400", "B4000000", "B460800", "B4800", "B50", "B500000", "B57600",
    "B576000", "B600", "B75", "B921600", "B9600", "I", "L_ctermid", "L_cuserid", "L_tmpnam",
    "PF_DECnet", "P_tmpdir", "arm", "bsd", "complex", "errno", "i386", "ifa_broadaddr",
    "ifa_dstaddr", "ifc_buf", "ifc_req", "ifr_addr", "ifr_bandwidth", "ifr_broadaddr", "ifr_data",
    "ifr_dstaddr", "ifr_flags", "ifr_hwaddr", "ifr_ifindex", "ifr_map", "ifr_metric", "ifr_mtu",
    "ifr_name", "ifr_netmask", "ifr_newname", "ifr_qlen", "ifr_slave", "imaginary", "linux",
    "math_errhandling", "mips", "noreturn", "s6_addr", "s6_addr16", "s6_addr32", "sa_handler",
    "sa_sigaction", "sgi", "si_addr", "si_addr_lsb", "si_arch", "si_band", "si_call_addr", "si_fd",
    "si_int", "si_lower", "si_overrun", "si_pid", "si_pkey", "si_ptr", "si_status", "si_stime",
    "si_syscall", "si_timerid", "si_uid", "si_upper", "si_utime", "si_value",
    "sigev_notify_attributes", "sigev_notify_function", "sparc", "st_atime", "st_ctime", "st_mtime",
    "stderr", "stdin", "stdout", "sun", "unix", "vax",
    // clang-format on
});

struct Elsewhere {
    std::string_view header;
    std::vector<std::string_view> names;
};

/// Macros of platforms that are not defined as names, without those in capitals and those with
/// arguments.
const std::vector<Elsewhere>& elsewhere() {
    static const std::vector<Elsewhere> all{
        {"<X11/X.h>",
         {"Above", "Always", "Below", "Complex", "Convex", "Nonconvex", "None", "Opposite",
          "Success", "Unsorted"}},
        {"<X11/Xlib.h>", {"Bool", "False", "Status", "True"}},
        {"<windows.h>",
         {"cdecl", "ctlFirst", "ctlLast", "exception_code", "exception_info", "far", "h_addr",
          "h_errno", "hyper", "interface", "near", "pascal", "s_addr", "s_host", "s_imp", "s_impno",
          "s_lh", "s_net", "small"}},
        {"Qt", {"emit", "foreach", "forever", "signals", "slots"}},
    };
    return all;
}

/// Controls of dialogs in <windows.h>: rad1, grp2, ...
constexpr std::array kControls = std::to_array<std::string_view>(
    {"chx", "cmb", "ctl", "edt", "frm", "grp", "ico", "lst", "psh", "rad", "rct", "scr", "stc"});

/// Functions and types at global scope in the C library and POSIX, which no namespace may be named
/// after. tests/spec/library_names_test.sh derives them from the headers.
constexpr std::array kLibrary = std::to_array<std::string_view>({
#include "check/names/library_names.inc"
});

// Required by binary search.
static_assert(std::is_sorted(kKeywords.begin(), kKeywords.end()));
static_assert(std::is_sorted(kGenerated.begin(), kGenerated.end()));
static_assert(std::is_sorted(kMacros.begin(), kMacros.end()));
static_assert(std::is_sorted(kLibrary.begin(), kLibrary.end()));
static_assert(std::is_sorted(kControls.begin(), kControls.end()));

template <std::size_t N>
bool contains(const std::array<std::string_view, N>& table, std::string_view name) {
    return std::binary_search(table.begin(), table.end(), name);
}

/// Mathematical functions also exist for the types _Float32 to _Float128: acosf32, acosf64x.
bool in_library(std::string_view name) {
    for (const std::string_view suffix : {"f32", "f32x", "f64", "f64x", "f128"}) {
        if (!name.ends_with(suffix)) continue;
        const std::string base(name.substr(0, name.size() - suffix.size()));
        if (contains(kLibrary, base) && contains(kLibrary, base + "f") &&
            contains(kLibrary, base + "l"))
            return true;
    }
    return contains(kLibrary, name);
}

bool is_upper(char c) {
    return std::isupper(static_cast<unsigned char>(c)) != 0;
}

bool is_lower(char c) {
    return std::islower(static_cast<unsigned char>(c)) != 0;
}

/// NULL, FLT_MAX, SPI1, but not G1. Firmware headers have too many of them for a list.
bool in_capitals(std::string_view name) {
    return std::count_if(name.begin(), name.end(), is_upper) > 1 &&
           std::none_of(name.begin(), name.end(), is_lower);
}

/// PRId32 in <inttypes.h>, M_PIf in <math.h>: not only capitals.
bool macro_family(std::string_view name) {
    return name.starts_with("PRI") || name.starts_with("SCN") || name.starts_with("M_");
}

std::string without_stray_underscores(std::string_view name) {
    std::string result;
    for (const char c : name)
        if (c != '_' || (!result.empty() && result.back() != '_')) result += c;
    if (result.ends_with('_')) result.pop_back();
    return result;
}

std::string in_lower_case(std::string name) {
    for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return name;
}

bool can_begin(std::string_view name) {
    return !name.empty() && std::isdigit(static_cast<unsigned char>(name[0])) == 0;
}

}  // namespace

std::optional<std::string_view> why_forbidden(std::string_view name, bool is_namespace) {
    if (contains(kKeywords, name)) return "is a C++ keyword";
    if (contains(kGenerated, name)) return "is a name that the generated code needs";
    if (name.starts_with('_') || name.ends_with('_') || name.find("__") != std::string_view::npos)
        return "has an underscore that is not between letters or digits; C++ and the generated "
               "code reserve those";
    if (in_capitals(name)) return "is all capitals, like macros of C";
    if (contains(kMacros, name) || macro_family(name))
        return "is a macro of common C headers or compilers";
    if (is_namespace && in_library(name))
        return "is a name of the C library, so no namespace can have it";
    return std::nullopt;
}

std::optional<std::string_view> macro_elsewhere(std::string_view name) {
    for (const auto& [header, names] : elsewhere())
        if (std::find(names.begin(), names.end(), name) != names.end()) return header;
    const std::string_view digits = name.substr(std::min<std::size_t>(name.size(), 3));
    const bool numbered = !digits.empty() && digits.find_first_not_of("0123456789") == name.npos;
    if (numbered && contains(kControls, name.substr(0, 3))) return "<windows.h>";
    const bool binary = name.size() > 1 && name.size() <= 9 && name[0] == 'B' &&
                        name.find_first_not_of("01", 1) == name.npos;
    return binary ? std::optional<std::string_view>("<Arduino.h>") : std::nullopt;
}

std::string allowed_name(std::string_view name, std::string_view kind, bool is_namespace) {
    std::string result = without_stray_underscores(name);
    if (in_capitals(result)) result = in_lower_case(result);
    if (can_begin(result) && !why_forbidden(result, is_namespace)) return result;
    if (!can_begin(result)) return std::string(kind) + "_" + result + (result.empty() ? "1" : "");
    return result + "_" + std::string(kind);
}

}  // namespace etlc::check
