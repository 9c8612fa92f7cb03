#include "prove/program.hpp"

#include <elf.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "prove/subject.hpp"

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
    const std::string said = read_all(compiler);
    if (compiler.exit_status() == 0) return std::nullopt;
    const std::size_t at = std::min(said.find("error:"), said.size());
    return fmt::format("the C++ compiler $CXX, or c++, does not compile the header for a proof{}{}",
                       at < said.size() ? ": " : "",
                       said.substr(at, std::min(said.find('\n', at), said.size()) - at));
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
    const auto whole = shell(pattern, fmt::format(fmt::runtime(kCompile),
                                                  "-Istand_in -Iruntime -O1 main.cpp -o program"));
    if (!object || !whole) return failure("cannot run the shell, /bin/sh");
    for (data::Child* const compiler : {object.get(), whole.get()})
        if (const auto said = complaint(*compiler)) return failure(*said);
    const std::string parts = writable_parts(read(folder / "object.o"));
    if (!parts.empty())
        return failure("the class may have variables besides its members: its object has " + parts);
    return program;
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
