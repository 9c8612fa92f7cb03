#include "prove/program.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <bit>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <utility>

#include "prove/text/members.hpp"

namespace etlc::prove {
namespace {

namespace fs = std::filesystem;

/// The longest time without output: of the compiler, and of the program between two verdicts.
constexpr int kMostSeconds = 3600;

bool write(const fs::path& path, std::string_view text) {
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    std::ofstream stream(path, std::ios::binary);
    stream.write(text.data(), static_cast<std::streamsize>(text.size()));
    return static_cast<bool>(stream.flush());
}

/// Returns "1, 3".
std::string indices(const plan::Plan& plan, bool repeating) {
    std::vector<std::size_t> found;
    for (std::size_t m = 0; m < plan.monitors.size(); ++m) {
        const check::Restarts restarts = plan.monitors[m].restarts;
        if (restarts == check::Restarts::when_final ||
            (!repeating && restarts == check::Restarts::on_request))
            found.push_back(m);
    }
    return fmt::format("{}", fmt::join(found, ", "));
}

/// Returns the windows of a class, by their types in the header, each once: "etlprove::
/// window_of_class<etlmon::Greatest, M::Value, 41>()".
std::string windows(const std::string& header, const std::string& name_space) {
    static const std::regex kWindow(R"(etlmon::Window<\s*etlmon::(\w+)<Value>,\s*(\d+)>|)"
                                    R"((?:AtLeast|AllBut)<Value,\s*(\d+),\s*(\d+)>)");
    std::set<std::string> found;
    for (std::sregex_iterator at(header.begin(), header.end(), kWindow), end; at != end; ++at) {
        const std::smatch& match = *at;
        const std::string of = match[1].matched
                                   ? "etlmon::" + match[1].str()
                                   : fmt::format("etlprove::Nth<{}>::Of", match[3].str());
        found.insert(fmt::format("etlprove::window_of_class<{}, {}::Monitor::Value, {}>()", of,
                                 name_space, match[match[1].matched ? 2 : 4].str()));
    }
    return fmt::format("{}", fmt::join(found, ",\n        "));
}

std::string main_text(const plan::Plan& plan, const Subject& subject,
                      const std::vector<Atom>& atoms) {
    std::string restarts;
    std::uint32_t horizon = 0;
    for (std::size_t m = 0; m < plan.monitors.size(); ++m) {
        horizon = std::max(horizon, plan.monitors[m].horizon);
        if (plan.monitors[m].restarts != check::Restarts::never)
            restarts +=
                fmt::format("    if (m == {}) monitor.restart_{}();\n", m, plan.monitors[m].name);
    }
    std::size_t read = 0;
    for (const Atom& atom : atoms) read += atom.is_read ? 1 : 0;
    return fmt::format(
        "#include \"etlprove/driver.hpp\"\n#include <class.hpp>\n\n"
        "static void restart({0}::Monitor& monitor, uint32_t m) {{\n"
        "    (void)monitor, (void)m;\n{1}}}\n\n"
        "int main(int count, char** words) {{\n    etlprove::end_with_etlc();\n"
        "    etlprove::take_numbers(count - 2, words + 2);\n"
        "    etlprove::Class<{0}::Monitor> about{{{2}, {3}, {4}, {{{5}}}, {{{6}}}, restart, "
        "{7},\n        {{{8}}}}};\n"
        "    etlprove::Driver<{0}::Monitor, {0}::Verdicts>(about, atoi(words[1])).run();\n}}\n",
        subject.name_space, restarts, read, atoms.size(), plan.monitors.size(),
        indices(plan, false), indices(plan, true), plan.has_sliding ? horizon : 0,
        windows(subject.header, subject.name_space));
}

/// Runs a command of the shell in the folder; $CXX may have several words.
std::unique_ptr<data::Child> shell(const std::string& folder, const std::string& command) {
    return data::Child::start(
        "/bin/sh", {"-c", "cd \"$0\" && " + command, folder},
        {.max_silence_seconds = kMostSeconds, .whole_environment = true, .heard = true});
}

std::string read_all(data::Child& child) {
    std::string text;
    for (char c = 0; child.read(&c, 1);) text += c;
    return text;
}

diag::Failure failure(const std::string& what) {
    return {diag::Code::no_proof, what};
}

}  // namespace

Program::Program(Program&& other) noexcept
    : folder_(std::exchange(other.folder_, "")), compiler_(std::move(other.compiler_)) {}

Program::~Program() {
    std::error_code error;
    if (!folder_.empty()) fs::remove_all(folder_, error);
}

diag::Result<Program> Program::make(const plan::Plan& plan, const Subject& subject,
                                    const std::vector<Atom>& atoms) {
    // A header that was edited may use a counter as only numbers can be used.
    return make({with_counters(subject.header), subject.header}, main_text(plan, subject, atoms),
                "-Istand_in -Iruntime", {});
}

diag::Result<Program> Program::make(const std::vector<std::string>& headers,
                                    const std::string& main, const std::string& folders,
                                    const std::vector<RuntimeFile>& files) {
    std::error_code error;
    std::string pattern = (fs::temp_directory_path(error) / "etlc-prove-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr)
        return failure(fmt::format("cannot make a temporary folder like '{}'", pattern));
    Program program(pattern);
    const fs::path folder = pattern;
    bool written = write(folder / "main.cpp", main);
    for (std::size_t h = 0; h < headers.size(); ++h)
        written = written && write(folder / fmt::format("header{}", h) / "class.hpp", headers[h]);
    for (const auto* const group : {&stand_in_files(), &files})
        for (const RuntimeFile& file : *group)
            written = written && write(folder / "stand_in" / file.name, file.text);
    for (const RuntimeFile& file : emit::runtime_files())
        written = written && write(folder / "runtime" / file.name, file.text);
    if (!written) return failure(fmt::format("cannot write to the temporary folder '{}'", pattern));
    const auto version = shell(pattern, "${CXX:-c++} --version");
    if (version) program.compiler_ = read_all(*version);
    program.compiler_.resize(std::min(program.compiler_.find('\n'), program.compiler_.size()));
    std::string said;
    for (std::size_t h = 0; h < headers.size(); ++h) {
        const auto compiler =
            shell(pattern, fmt::format("${{CXX:-c++}} -std=c++17 -O1 -w -DETLMON_NO_DISPATCH {} "
                                       "-Iheader{} main.cpp -o program 2>&1",
                                       folders, h));
        if (!compiler) return failure("cannot run the shell, /bin/sh");
        said = read_all(*compiler);
        if (compiler->exit_status() == 0) return program;
    }
    const std::size_t at = std::min(said.find("error:"), said.size());
    return failure(
        fmt::format("the C++ compiler $CXX, or c++, does not compile the header for a proof{}{}",
                    at < said.size() ? ": " : "",
                    said.substr(at, std::min(said.find('\n', at), said.size()) - at)));
}

std::unique_ptr<data::Child> Program::start(const std::set<float>& numbers,
                                            std::uint32_t steps) const {
    std::vector<std::string> words{fmt::format("{}", steps)};
    for (const float number : numbers)
        words.push_back(fmt::format("{:08x}", std::bit_cast<std::uint32_t>(number)));
    return data::Child::start(folder_ + "/program", words,
                              {.max_silence_seconds = kMostSeconds, .heard = true});
}

}  // namespace etlc::prove
