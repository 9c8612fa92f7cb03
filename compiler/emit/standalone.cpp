#include "emit/standalone.hpp"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <set>

namespace etlc::emit {

namespace {

constexpr std::string_view kInclude = "#include \"";
constexpr std::string_view kOnce = "#pragma once";

/// "etlmon/window.hpp" of `#include "etlmon/window.hpp"`; empty for any other line.
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

class Pasting {
public:
    std::string paste(std::string_view text) {
        std::string result;
        while (!text.empty()) {
            const std::size_t end = std::min(text.find('\n'), text.size() - 1);
            const std::string_view line = text.substr(0, end);
            text.remove_prefix(end + 1);
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

    std::set<std::string> done_;
};

}  // namespace

std::string standalone(const std::string& header) {
    return Pasting().paste(header);
}

}  // namespace etlc::emit
