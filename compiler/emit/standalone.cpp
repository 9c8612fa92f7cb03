#include "emit/standalone.hpp"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <optional>
#include <set>

namespace etlc::emit {

namespace {

constexpr std::string_view kInclude = "#include \"";
constexpr std::string_view kLicense = "// SPDX-License-Identifier: MIT";
constexpr std::string_view kOnce = "#pragma once";
constexpr std::string_view kOpen = "namespace etlmon {\ninline namespace ETLMON_BUILD {\n";
constexpr std::string_view kClose = "}  // namespace ETLMON_BUILD\n}  // namespace etlmon\n";

/// Returns "etlmon/temporal/window.hpp" of `#include "etlmon/temporal/window.hpp"`; empty for other
/// lines.
std::string_view included(std::string_view line) {
    if (!line.starts_with(kInclude)) return {};
    line.remove_prefix(kInclude.size());
    return line.substr(0, line.find('"'));
}

/// Removes the first line from a text, and returns it.
std::string_view take_line(std::string_view& text) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return line;
}

/// Removes blank lines at the ends, and one of two in a row.
std::string tidy(std::string_view text) {
    std::string result;
    bool apart = false;
    while (!text.empty()) {
        const std::string_view line = take_line(text);
        if (line.empty()) {
            apart = !result.empty();
            continue;
        }
        if (apart) result += '\n';
        apart = false;
        result.append(line).push_back('\n');
    }
    return result;
}

/// Returns ETLMON_PASTED_WINDOW_HPP.
std::string guard_of(std::string_view name) {
    std::string guard = "ETLMON_PASTED_";
    for (char c : name.substr(name.find('/') + 1))
        guard += std::isalnum(static_cast<unsigned char>(c)) != 0
                     ? static_cast<char>(std::toupper(static_cast<unsigned char>(c)))
                     : '_';
    return guard;
}

/// Returns the value of an `#if` condition in portable text, where ETLMON_PORTABLE and
/// ETLMON_STANDALONE are defined and gnu.hpp is not included; nothing if the compiler has to
/// decide.
std::optional<bool> portable_value(std::string_view condition) {
    const auto has = [&](std::string_view part) {
        return condition.find(part) != std::string_view::npos;
    };
    if (has("!defined(ETLMON_GNU)") || has("!defined(ETLMON_VECTORS)")) return true;
    if (has("!defined(ETLMON_PORTABLE)") || has("defined(ETLMON_VECTORS)")) return false;
    if (has("defined(ETLMON_PORTABLE)") || has("defined(ETLMON_STANDALONE)")) return true;
    return std::nullopt;
}

/// The conditions around a line; leaves out lines that portable text does not have.
class Conditions {
public:
    /// Returns whether a line of a runtime file is pasted.
    bool keeps(std::string_view line) {
        if (line.starts_with("#if")) {
            open_.push_back(portable_value(line));
            taken_.push_back(open_.back().value_or(true));
            return !open_.back() && all_taken();
        }
        const bool known = !open_.empty() && open_.back();
        if (line.starts_with("#el") && known) {
            taken_.back() = line.starts_with("#else") && !*open_.back();
            return false;
        }
        const bool kept = all_taken();
        if (!line.starts_with("#endif")) return kept;
        open_.pop_back();
        taken_.pop_back();
        return kept && !known;
    }

private:
    bool all_taken() const {
        return std::find(taken_.begin(), taken_.end(), false) == taken_.end();
    }

    std::vector<std::optional<bool>> open_;  ///< value of each condition
    std::vector<bool> taken_;                ///< whether its lines are pasted
};

/// Shortens the first comment of a file: Takes, Gives and Keeps true are for those who change the
/// file.
std::string with_short_comment(std::string_view text) {
    std::string result;
    while (text.starts_with("//")) {
        const std::string_view line = take_line(text);
        const std::size_t contract =
            std::min({line.find("Takes"), line.find("Gives"), line.find("Keeps true")});
        if (contract > 3)
            result.append(line.substr(0, line.find_last_not_of(' ', contract - 1) + 1));
        if (contract > 3) result += '\n';
        if (contract == line.npos) continue;
        while (text.starts_with("//")) take_line(text);
    }
    return result + std::string(text);
}

/// Returns the contents of the runtime's namespace in a file, and the comment before it; nothing if
/// the file has other code outside it.
std::optional<std::string> only_in_namespace(const std::string& text) {
    const std::size_t open = text.find(kOpen);
    if (open == text.npos || !text.ends_with(kClose)) return std::nullopt;
    for (std::size_t at = 0; at < open; at = text.find('\n', at) + 1)
        if (text[at] != '/' && text[at] != '\n') return std::nullopt;
    const std::size_t from = open + kOpen.size();
    const std::string inner = text.substr(from, text.size() - kClose.size() - from);
    if (inner.find(kOpen) != inner.npos) return std::nullopt;
    return text.substr(0, open) + inner;
}

/// Returns the text between include guards, since a program may include several such headers.
std::string guarded(std::string_view name, const std::string& text) {
    const std::string guard = guard_of(name);
    return "\n// ---- " + std::string(name) + "\n#ifndef " + guard + "\n#define " + guard + "\n" +
           text + "#endif  // " + guard + "\n";
}

std::string_view runtime_text(std::string_view name) {
    const auto& files = runtime_files();
    const auto found = std::find_if(files.begin(), files.end(),
                                    [&](const RuntimeFile& f) { return f.name == name; });
    assert(found != files.end());
    return found->text;
}

class Pasting {
public:
    explicit Pasting(bool portable) : portable_(portable) {}

    std::string paste(std::string_view header) {
        const std::size_t begin = header.find(kOnce) + kOnce.size();
        const std::string rest = tidy(text_of(header.substr(begin), true));
        leave_namespace();
        std::string result(header.substr(0, begin));
        result += "\n\n";
        for (const std::string& line : of_c_) result += line + "\n";
        result.append("\n// The part of etlc's runtime that this header needs.\n").append(kLicense);
        return result + "\n" + pasted_ + "\n" + rest;
    }

private:
    /// Returns a text without its includes, which are pasted before it. Files that are included
    /// several times (.inc) or under a condition replace their include. `hoist`: removes C headers
    /// too.
    std::string text_of(std::string_view text, bool hoist) {
        std::string result;
        Conditions conditions;
        int depth = 0;
        while (!text.empty()) {
            const std::string_view line = take_line(text);
            if (portable_ && !conditions.keeps(line)) continue;
            depth += line.starts_with("#if") ? 1 : line.starts_with("#endif") ? -1 : 0;
            const std::string_view name = included(line);
            if (name.ends_with(".inc"))
                result += text_of(runtime_text(name), false);
            else if (!name.empty() && depth == 0)
                paste_file(name);
            else if (!name.empty() && done_.insert(std::string(name)).second)
                result += guarded(name, tidy(text_of(runtime_text(name), false)));
            else if (hoist && depth == 0 && line.starts_with("#include <"))
                of_c_.insert(std::string(line));
            else if (name.empty() && line != kOnce && line != kLicense)
                result.append(line).push_back('\n');
        }
        return result;
    }

    /// Pastes a runtime file after those that it includes, once. Consecutive files share one
    /// namespace block.
    void paste_file(std::string_view name) {
        if (!done_.insert(std::string(name)).second) return;
        const std::string text = with_short_comment(tidy(text_of(runtime_text(name), true)));
        const std::optional<std::string> inner = only_in_namespace(text);
        if (!inner) leave_namespace();
        if (inner && !in_namespace_) pasted_.append("\n").append(kOpen);
        in_namespace_ = inner.has_value();
        pasted_ += guarded(name, inner ? tidy(*inner) : text);
    }

    void leave_namespace() {
        if (in_namespace_) pasted_.append("\n").append(kClose);
        in_namespace_ = false;
    }

    bool portable_;
    std::set<std::string> done_;  ///< files
    std::set<std::string> of_c_;  ///< includes of C headers
    std::string pasted_;
    bool in_namespace_ = false;  ///< whether a namespace block is open
};

}  // namespace

std::string standalone(const std::string& header, std::string_view target) {
    return Pasting(target == "portable").paste(header);
}

}  // namespace etlc::emit
