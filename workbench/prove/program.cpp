#include "prove/program.hpp"

#include <elf.h>
#include <unistd.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <utility>

#include "emit/names.hpp"

namespace etlc::prove {

namespace {

namespace fs = std::filesystem;

// ---- the text of the program: what the class has, by the names that etlc gave it. Nothing is read
// from the text of the class but which files of the runtime it includes.

/// Returns the lines that include files of the runtime.
std::string includes_of(const std::string& header) {
    constexpr std::string_view kInclude = "#include \"etlmon/";
    std::string lines;
    for (std::size_t at = 0; at < header.size();) {
        const std::size_t end = std::min(header.find('\n', at), header.size());
        const std::string_view line = std::string_view(header).substr(at, end - at);
        if (line.starts_with(kInclude)) lines.append(line) += '\n';
        at = end + 1;
    }
    return lines;
}

std::string constructor_arguments(const plan::Plan& plan) {
    return plan.stored.empty() || plan.model->retargetable ? "" : "nullptr, 0";
}

/// The text of the functions of a Subject, which stand_in/etlprove/calls.hpp uses.
class Writer {
public:
    Writer(const plan::Plan& plan, const Request& request, const std::vector<Atom>& atoms)
        : plan_(plan), request_(request), atoms_(atoms), names_(emit::make_names(plan)) {}

    std::string subject() const {
        const bool boolean = plan_.values == check::Values::boolean;
        std::string text = fmt::format(
            "struct Subject {{\n    using Monitor = {0}::Monitor;\n"
            "    using Verdicts = {0}::Verdicts;\n"
            "    static constexpr uint32_t kMonitors = {1};\n"
            "    static constexpr bool kRepeats = {2}, kMeasures = {3};\n"
            "    static void construct(void* at) {{ new (at) Monitor({4}); }}\n"
            "    static {0}::Inputs inputs(bool present) {{\n        {0}::Inputs in;\n"
            "        (void)present;\n{6}        return in;\n    }}\n"
            "    static Verdicts step(Monitor& monitor) {{ return monitor.step({{}}); }}\n"
            "    static Verdicts finish(Monitor& monitor) {{ return {5}; }}\n",
            request_.name_space, plan_.monitors.size(), repeats(), !plan_.model->retargetable,
            constructor_arguments(plan_),
            plan_.has_sliding ? "monitor.finish()" : "(void)monitor, Verdicts()", samples());
        text += boolean ? "    static Verdicts judge(Monitor& monitor) { return step(monitor); }\n"
                          "    static Verdicts step_with(Monitor& monitor, bool present) {\n"
                          "        etlprove::is_measuring() = true;\n"
                          "        const Verdicts verdicts = monitor.step(inputs(present));\n"
                          "        etlprove::is_measuring() = false;\n"
                          "        return verdicts;\n    }\n"
                          "    static bool measures(Monitor&) { return true; }\n"
                        : halves();
        return text + restarts() + answers() + telemetry() + "};\n";
    }

    /// Returns the atoms in the order in which a step asks for them.
    std::string order(const std::vector<Truths>& truths) const {
        std::vector<std::string> all;
        const auto add = [&](bool is_predicate, check::Index index) {
            for (std::size_t a = 0; a < atoms_.size(); ++a)
                if (atoms_[a].is_read && atoms_[a].is_predicate == is_predicate &&
                    atoms_[a].index == index)
                    all.push_back(fmt::format("{{{}, etlprove::Truths({}), {}, {}}}", a,
                                              truths.empty() ? 0 : static_cast<int>(truths[a]),
                                              vanishes(atoms_[a]), missing(atoms_[a])));
        };
        for (const check::Index input : plan_.inputs) add(false, input);
        for (const check::Index predicate : plan_.predicates) add(true, predicate);
        return fmt::format("{}", fmt::join(all, ", "));
    }

private:
    const plan::Plan& plan_;
    const Request& request_;
    const std::vector<Atom>& atoms_;
    const emit::Names names_;

    bool repeats() const { return !names_.alarms_member.empty(); }

    /// Returns one line for each monitor.
    template <class Line>
    std::string for_each(const Line& line) const {
        std::string text;
        for (std::uint32_t m = 0; m < plan_.monitors.size(); ++m) text += line(m);
        return text;
    }

    std::string name_of(const Atom& atom) const {
        return (atom.is_predicate ? names_.predicate_atom : names_.flag_atom).at(atom.index);
    }

    /// Samples that are there. Which ones does not count.
    std::string samples() const {
        std::string text;
        for (const check::Index i : plan_.inputs) {
            const check::Input& input = plan_.model->inputs[i];
            const double number =
                std::max<double>(input.range.low, std::min<double>(input.range.high, 0));
            text += fmt::format("        if (present) etlprove::give(in.{}, {});\n", input.name,
                                number);
        }
        return text;
    }

    /// The two halves of a step. An atom is found by its name.
    std::string halves() const {
        std::string set, same;
        for (std::size_t a = 0; a < atoms_.size(); ++a) {
            if (!atoms_[a].is_read) continue;
            set += fmt::format("        now.{} = Value(etlprove::samples().value({}));\n",
                               name_of(atoms_[a]), a);
            same += fmt::format(" &&\n            is(now.{}, {})", name_of(atoms_[a]), a);
        }
        return fmt::format(
            "    using Value = Monitor::Value;\n"
            "    static Verdicts judge(Monitor& monitor) {{\n        Monitor::Atoms now{{}};\n{}"
            "        return monitor.judge(now);\n    }}\n"
            "    static Verdicts step_with(Monitor& monitor, bool present) {{\n"
            "        etlprove::is_measuring() = true;\n"
            "        (void)monitor.measure(inputs(present));\n"
            "        etlprove::is_measuring() = false;\n"
            "        return judge(monitor);\n    }}\n"
            "    static bool measures(Monitor& monitor) {{\n"
            "        const Monitor::Atoms now = monitor.measure({{}});\n"
            "        const auto is = [](Value found, uint32_t atom) {{\n"
            "            const Value expected = etlprove::samples().value(atom);\n"
            "            return memcmp(&found, &expected, sizeof found) == 0;\n        }};\n"
            "        (void)now, (void)is;\n        return true{};\n    }}\n",
            set, same);
    }

    std::string restarts() const {
        const auto is = [&](const char* name, const auto& holds) {
            return fmt::format(
                "    static bool {}(uint32_t m) {{\n        (void)m;\n{}"
                "        return false;\n    }}\n",
                name, for_each([&](std::uint32_t m) {
                    return holds(m) ? fmt::format("        if (m == {}) return true;\n", m)
                                    : std::string();
                }));
        };
        const auto restarts = [&](std::uint32_t m) {
            return plan_.monitors[m].restarts != check::Restarts::never;
        };
        const auto repeats = [&](std::uint32_t m) { return names_.alarms_member.contains(m); };
        std::string text = is("restarts", restarts) + is("repeats", repeats);
        text +=
            "    static void restart(Monitor& monitor, uint32_t m) {\n        (void)monitor, "
            "(void)m;\n";
        text += for_each([&](std::uint32_t m) {
            return restarts(m) ? fmt::format("        if (m == {}) monitor.restart_{}();\n", m,
                                             plan_.monitors[m].name)
                               : std::string();
        });
        text +=
            "    }\n    static std::pair<uint32_t, uint32_t> counts(const Monitor& monitor, "
            "uint32_t m) {\n        (void)monitor, (void)m;\n";
        text += for_each([&](std::uint32_t m) {
            return repeats(m) ? fmt::format(
                                    "        if (m == {0}) return {{monitor.alarms_{1}(), "
                                    "monitor.fulfilled_{1}()}};\n",
                                    m, plan_.monitors[m].name)
                              : std::string();
        });
        return text + "        return {0, 0};\n    }\n";
    }

    /// The verdicts, by their names.
    std::string answers() const {
        std::vector<std::string> names;
        for (const plan::Monitor& monitor : plan_.monitors)
            names.push_back('"' + monitor.name + '"');
        return fmt::format(
            "    static auto of(const Verdicts& verdicts, uint32_t m) {{\n{}"
            "        return &verdicts.{};\n    }}\n"
            "    static etlprove::Answer answer(const Verdicts& verdicts, uint32_t m) {{\n"
            "        return etlprove::answer_of(*of(verdicts, m));\n    }}\n"
            "    static bool is_named(const Verdicts& verdicts) {{\n"
            "        static const char* const names[] = {{{}}};\n"
            "        uint32_t m = 0;\n"
            "        for (const auto& [name, verdict] : named(verdicts)) {{\n"
            "            if (m == kMonitors || strcmp(name, names[m]) != 0) return false;\n"
            "            if (memcmp(&verdict, of(verdicts, m++), sizeof verdict) != 0) return "
            "false;\n"
            "        }}\n        return m == kMonitors;\n    }}\n",
            for_each([&](std::uint32_t m) {
                return fmt::format("        if (m == {}) return &verdicts.{};\n", m,
                                   plan_.monitors[m].name);
            }),
            plan_.monitors[0].name, fmt::join(names, ", "));
    }

    /// Members that no verdict depends on, and the windows over pairs.
    std::string telemetry() const {
        std::vector<std::string> members{"&monitor.incomplete_"};
        for (const auto* const names : {&names_.alarms_member, &names_.fulfilled_member})
            for (const auto& [m, name] : *names) members.push_back("&monitor." + name);
        std::string text = fmt::format(
            "    static std::vector<const void*> telemetry(const Monitor& monitor) {{\n"
            "        return {{{}}};\n    }}\n"
            "    static std::vector<etlprove::WindowOfClass> windows(const Monitor& monitor) {{\n"
            "        (void)monitor;\n        std::vector<etlprove::WindowOfClass> all;\n",
            fmt::join(members, ", "));
        for (const emit::Names::OfStream& stream : names_.streams)
            if (!stream.member.empty())
                text +=
                    fmt::format("        etlprove::add_window(all, monitor.{});\n", stream.member);
        return text + "        return all;\n    }\n";
    }

    /// Whether an atom is missing at a step without samples: nothing of earlier steps stands in.
    bool vanishes(const Atom& atom) const {
        const check::Model& model = *plan_.model;
        if (!atom.is_predicate) return model.inputs[atom.index].hold == 0;
        const auto& inputs = model.predicates[atom.index].inputs;
        return names_.past_member.empty() && names_.earlier_member.empty() && !inputs.empty() &&
               std::all_of(inputs.begin(), inputs.end(),
                           [&](const check::Index i) { return model.inputs[i].hold == 0; });
    }
    bool missing(const Atom& atom) const {
        const std::optional<bool> missing = atom.is_predicate
                                                ? plan_.model->predicates[atom.index].missing
                                                : plan_.model->inputs[atom.index].missing;
        return missing.value_or(false);
    }
};

/// Returns the program that drives the class on symbols. `truths`: of each atom, in a class of
/// truth values.
std::string program_text(const plan::Plan& plan, const Request& request,
                         const std::vector<Atom>& atoms, const std::vector<Truths>& truths) {
    const Writer writer(plan, request, atoms);
    const bool boolean = plan.values == check::Values::boolean;
    return fmt::format(
        "#include \"etlprove/driver.hpp\"\n{0}\n#define private public\n"
        "#define static_assert(...) static_assert(true, \"\")\n"
        "#define uint32_t etlprove::Word\n{1}#include \"class.hpp\"\n{2}#undef uint32_t\n"
        "#undef static_assert\n#undef private\n\n{3}\n"
        "int main(int count, char** words) {{\n    etlprove::end_with_etlc();\n"
        "    etlprove::are_truths() = {4};\n    etlprove::recorded().is = {5};\n"
        "    etlprove::take_numbers(count - 2, words + 2);\n"
        "    etlprove::ways().set_most({6});\n"
        "    const uint32_t steps = static_cast<uint32_t>(atoi(words[1]));\n"
        "    etlprove::samples().describe({{{7}}}, {8}, steps + {9});\n"
        "    etlprove::Driver<Subject>({{steps, {9}, {10}}}).run();\n}}\n",
        includes_of(request.header), boolean ? "#define bool etlprove::Bit\n" : "",
        boolean ? "#undef bool\n" : "", writer.subject(), boolean, plan.recorder.has_value(),
        request.most_ways, writer.order(truths), atoms.size(), finishes_of(plan),
        request.most_together);
}

/// Returns a source whose object has everything that the class needs.
std::string object_text(const plan::Plan& plan, const Request& request) {
    const auto for_each = [&](const char* text, const auto& has) {
        std::string lines;
        for (const plan::Monitor& monitor : plan.monitors)
            if (has(monitor)) lines += fmt::format(fmt::runtime(text), monitor.name);
        return lines;
    };
    const bool has_pointer = !plan.stored.empty() || plan.model->retargetable;
    return fmt::format(
        "#include <new>\n#include \"class.hpp\"\n\nusing {0}::Monitor;\n"
        "static_assert(sizeof(Monitor) == {1}, \"the state is as planned\");\n"
        "void uses(void* at, const {0}::Inputs& in, {0}::Verdicts& verdicts) {{\n"
        "    Monitor& monitor = *new (at) Monitor({2});\n    monitor.reset();\n"
        "    verdicts = monitor.step(in);\n{3}{4}    (void)named(verdicts);\n}}\n",
        request.name_space,
        has_pointer ? fmt::format("etlmon::with_pointer({})", plan.cost.state_bytes)
                    : fmt::format("{}", plan.cost.state_bytes),
        constructor_arguments(plan), plan.has_sliding ? "    verdicts = monitor.finish();\n" : "",
        for_each("    monitor.restart_{}();\n", [](const plan::Monitor& monitor) {
            return monitor.restarts != check::Restarts::never;
        }));
}

// ---- its compilation

/// The longest time without output: of the compiler, and of the program between two verdicts.
constexpr int kMostSeconds = 3600;

bool write(const fs::path& path, std::string_view text) {
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    std::ofstream stream(path, std::ios::binary);
    stream.write(text.data(), static_cast<std::streamsize>(text.size()));
    return static_cast<bool>(stream.flush());
}

std::string read(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
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

/// Waits for a compiler. Returns what it says where it fails.
std::optional<std::string> complaint(data::Child& compiler) {
    const std::string output = read_all(compiler);
    if (compiler.exit_status() == 0) return std::nullopt;
    const std::size_t at = std::min(output.find("error:"), output.size());
    return fmt::format("the C++ compiler $CXX, or c++, does not compile the header for a proof{}{}",
                       at < output.size() ? ": " : "",
                       output.substr(at, std::min(output.find('\n', at), output.size()) - at));
}

template <class Type>
Type at(const std::string& bytes, std::size_t place) {
    Type value{};
    if (place <= bytes.size() && bytes.size() - place >= sizeof value)
        std::memcpy(&value, bytes.data() + place, sizeof value);
    return value;
}

}  // namespace

std::string writable_parts(const std::string& object) {
    const auto header = at<Elf64_Ehdr>(object, 0);
    if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0 ||
        header.e_ident[EI_CLASS] != ELFCLASS64 || header.e_shnum == 0)
        return "no ELF file of 64 bits";
    const auto section = [&](std::size_t n) {
        return at<Elf64_Shdr>(object, header.e_shoff + n * sizeof(Elf64_Shdr));
    };
    const std::size_t names = section(header.e_shstrndx).sh_offset;
    std::string result;
    for (std::size_t n = 1; n < header.e_shnum; ++n) {
        const Elf64_Shdr of = section(n);
        if ((of.sh_flags & SHF_WRITE) == 0 || of.sh_size == 0) continue;
        const std::size_t name = std::min(names + of.sh_name, object.size());
        result +=
            fmt::format("{}{} in {}", result.empty() ? "" : ", ", diag::counted(of.sh_size, "byte"),
                        object.substr(name, object.find('\0', name) - name));
    }
    return result;
}

Program::Program(Program&& other) noexcept
    : folder_(std::exchange(other.folder_, "")), compiler_(std::move(other.compiler_)) {}

Program::~Program() {
    std::error_code error;
    if (!folder_.empty()) fs::remove_all(folder_, error);
}

diag::Result<Program> Program::make(const plan::Plan& plan, const Request& request,
                                    const std::vector<Atom>& atoms,
                                    const std::vector<Truths>& truths) {
    std::error_code error;
    std::string pattern = (fs::temp_directory_path(error) / "etlc-prove-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr)
        return failure(fmt::format("cannot make a temporary folder like '{}'", pattern));
    Program program(pattern);
    const fs::path folder = pattern;
    bool written = write(folder / "main.cpp", program_text(plan, request, atoms, truths)) &&
                   write(folder / "object.cpp", object_text(plan, request)) &&
                   write(folder / "header/class.hpp", request.header);
    for (const RuntimeFile& file : stand_in_files())
        written = written && write(folder / "stand_in" / file.name, file.text);
    for (const RuntimeFile& file : emit::runtime_files())
        written = written && write(folder / "runtime" / file.name, file.text);
    if (!written) return failure(fmt::format("cannot write to the temporary folder '{}'", pattern));
    const auto version = shell(pattern, "${CXX:-c++} --version");
    if (version) program.compiler_ = read_all(*version);
    program.compiler_.resize(std::min(program.compiler_.find('\n'), program.compiler_.size()));

    constexpr const char* kCompile =
        "${{CXX:-c++}} -std=c++17 -w -DETLMON_NO_DISPATCH -Iheader {} 2>&1";
    const auto object = shell(
        pattern,
        fmt::format(fmt::runtime(kCompile), "-Iruntime -O0 -fno-pie -c object.cpp -o object.o"));
    // A function that is always inlined would have its branches once for each caller.
    const char* const way = request.counts_lines ? "-O0 --coverage -fno-exceptions "
                                                   "-Dalways_inline=unused -DETLPROVE_COUNTS"
                                                 : "-O1";
    const auto whole = shell(
        pattern, fmt::format(fmt::runtime(kCompile),
                             fmt::format("-Istand_in -Iruntime {} main.cpp -o program", way)));
    if (!object || !whole) return failure("cannot run the shell, /bin/sh");
    for (data::Child* const compiler : {object.get(), whole.get()})
        if (const auto output = complaint(*compiler)) return failure(*output);
    const std::string parts = writable_parts(read(folder / "object.o"));
    if (!parts.empty())
        return failure("the class may have variables besides its members: its object has " + parts);
    return program;
}

std::string Program::coverage() const {
    const auto counts =
        shell(folder_, "${GCOV:-gcov} --branch-probabilities --json-format --stdout *.gcda 2>&1");
    return counts ? read_all(*counts) : "";
}

std::unique_ptr<data::Child> Program::start(const std::set<float>& numbers,
                                            std::uint32_t steps) const {
    std::vector<std::string> words{fmt::format("{}", steps)};
    for (const float number : numbers)
        words.push_back(fmt::format("{:08x}", std::bit_cast<std::uint32_t>(number)));
    return data::Child::start(folder_ + "/program", words,
                              {.max_silence_seconds = kMostSeconds, .heard = true});
}

// ---- what the program says, as stand_in/etlprove/diagrams.hpp lists it

void Answers::end() {
    const int status = child_.exit_status();
    throw Ended{status, child_.ending()};
}

std::uint32_t Answers::word() {
    char bytes[sizeof(std::uint32_t)];
    if (!child_.read(bytes, sizeof bytes)) end();
    std::uint32_t word = 0;
    std::memcpy(&word, bytes, sizeof word);
    return word;
}

Diagram Answers::known(std::uint32_t theirs) const {
    const auto found = known_.find(theirs);
    if (found == known_.end()) throw Ended{0, "contradicts itself"};
    return found->second;
}

etlprove::Entry Answers::next() {
    using etlprove::Entry;
    for (;;) {
        const auto entry = static_cast<Entry>(word());
        if (entry == Entry::number) throw NewNumber{std::bit_cast<float>(word())};
        if (entry != Entry::node) return entry;
        const std::uint32_t theirs = word();
        const Place place = word();
        const Diagram without = known(word());
        const Diagram with = known(word());
        known_[theirs] = space_.diagrams.choose(place, without, with);
    }
}

Reported Answers::verdict() {
    Reported reported;
    reported.may_be_missing = word() == 1;
    for (std::uint32_t* const field : {&reported.monitor, &reported.step, &reported.finishes})
        *field = word();
    reported.numbers.decided = word() == 1;
    for (std::size_t m = 0; m < monitors_; ++m) reported.begun.push_back(word());
    Numbers& numbers = reported.numbers;
    for (Diagram* const field : {&numbers.low, &numbers.high, &numbers.lower, &numbers.upper,
                                 &reported.satisfied, &reported.violated, &reported.final})
        *field = known(word());
    return reported;
}

State Answers::state() {
    State state;
    for (std::uint32_t count = word(); count > 0; --count) {
        State::Word next;
        next.kind = static_cast<etlprove::WordKind>(word());
        next.value = word();
        next.counted = word();
        if (next.kind == etlprove::WordKind::diagram) next.value = known(next.value);
        state.words.push_back(next);
    }
    state.oldest_negated = word();
    return state;
}

Window Answers::window() {
    Window window;
    window.length = word();
    const std::uint32_t answer = word();
    window.is_two_windows = answer == 1;
    window.is_too_long = answer == 2;
    return window;
}

std::string why(const Ended& ended) {
    switch (ended.status) {
        case etlprove::kBranches: return "the class compares two values and branches on the result";
        case etlprove::kExhausted: return "the diagrams of the class are too large";
        case etlprove::kTooMany: return "the class has too many states and ways through a step";
        case etlprove::kLeftovers:
            return "the class keeps something after reset(), or after a restart";
        case etlprove::kReadsTelemetry:
            return "a verdict may depend on what the class counts for telemetry";
        case etlprove::kOtherHalves:
            return "step() does something else than measure() and judge() one after the other";
        case etlprove::kOtherNames:
            return "the class gives a verdict or an atom the name of another";
        case etlprove::kNotReset: return "the class uses a part of its state that it has not reset";
        case etlprove::kOtherRestarts:
            return "after a final verdict the class does something else than to count it and to "
                   "restart that monitor";
        default: return "the class, compiled for the proof, " + ended.how;
    }
}

}  // namespace etlc::prove
