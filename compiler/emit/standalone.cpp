#include "emit/standalone.hpp"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <optional>
#include <set>

namespace etlc::emit {

namespace {

constexpr std::string_view kInclude = "#include \"";
constexpr std::string_view kOnce = "#pragma once";

/// "etlmon/temporal/window.hpp" of `#include "etlmon/temporal/window.hpp"`; empty for any other
/// line.
std::string_view included(std::string_view line) {
    if (!line.starts_with(kInclude)) return {};
    line.remove_prefix(kInclude.size());
    return line.substr(0, line.find('"'));
}

/// ETLMON_PASTED_WINDOW_HPP
std::string guard_of(std::string_view name) {
    std::string guard = "ETLMON_PASTED_";
    for (char c : name.substr(name.find('/') + 1))
        guard += std::isalnum(static_cast<unsigned char>(c)) != 0
                     ? static_cast<char>(std::toupper(static_cast<unsigned char>(c)))
                     : '_';
    return guard;
}

/// What a condition of `#if` comes to in portable text, where ETLMON_PORTABLE is defined and
/// gnu.hpp is not included; nothing where the compiler has to say.
std::optional<bool> portable_value(std::string_view condition) {
    const auto has = [&](std::string_view part) {
        return condition.find(part) != std::string_view::npos;
    };
    if (has("!defined(ETLMON_GNU)") || has("!defined(ETLMON_VECTORS)")) return true;
    if (has("!defined(ETLMON_PORTABLE)") || has("defined(ETLMON_VECTORS)")) return false;
    if (has("defined(ETLMON_PORTABLE)")) return true;
    return std::nullopt;
}

/// The conditions around a line. Leaves out what portable text does not have.
class Conditions {
public:
    /// Whether a line of a runtime file is pasted.
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

    std::vector<std::optional<bool>> open_;  ///< what each of them comes to
    std::vector<bool> taken_;                ///< and whether its lines are pasted
};

class Pasting {
public:
    explicit Pasting(bool portable) : portable_(portable) {}

    std::string paste(std::string_view text) {
        std::string result;
        Conditions conditions;
        while (!text.empty()) {
            const std::size_t end = std::min(text.find('\n'), text.size() - 1);
            const std::string_view line = text.substr(0, end);
            text.remove_prefix(end + 1);
            if (portable_ && !conditions.keeps(line)) continue;
            if (const std::string_view name = included(line); !name.empty())
                result += file(name);
            else
                result.append(line).push_back('\n');
        }
        return result;
    }

private:
    /// A runtime file between guards, and before it those that it includes; nothing where it stands
    /// already. What is included several times (.inc) is pasted each time.
    std::string file(std::string_view name) {
        const bool repeated = name.ends_with(".inc");
        if (!repeated && !done_.insert(std::string(name)).second) return "";
        const auto& files = runtime_files();
        const auto found = std::find_if(files.begin(), files.end(),
                                        [&](const RuntimeFile& f) { return f.name == name; });
        assert(found != files.end());
        std::string body = paste(found->text);
        if (repeated) return body;
        if (const std::size_t once = body.rfind(kOnce); once != std::string::npos)
            body.erase(once, kOnce.size() + 1);
        const std::string guard = guard_of(name);
        return "\n// ---- " + std::string(name) + "\n#ifndef " + guard + "\n#define " + guard +
               "\n" + body + "#endif  // " + guard + "\n";
    }

    bool portable_;
    std::set<std::string> done_;
};

}  // namespace

std::string standalone(const std::string& header, std::string_view target) {
    return Pasting(target == "portable").paste(header);
}

}  // namespace etlc::emit
