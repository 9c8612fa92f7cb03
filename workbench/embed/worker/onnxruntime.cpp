#include "embed/worker/onnxruntime.hpp"

#include <dlfcn.h>
#include <elf.h>
#include <link.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

#include "embed/worker/worker.hpp"
#include "recordings/frames/protocol.hpp"

namespace etlc::embed::worker {

namespace {

namespace fs = std::filesystem;
using recordings::frames::kNoRuntime;
using Paths = std::vector<fs::path>;

constexpr std::string_view kLibrary = "libonnxruntime.so";
constexpr char kExpected[] = ", expected ONNX Runtime 1.13 or later";
#if defined(__aarch64__)
constexpr std::string_view kNodeMachine = "arm64";
#else
constexpr std::string_view kNodeMachine = "x64";
#endif

[[noreturn]] void refuse_library(const std::string& what) {
    refuse(kNoRuntime, "is not run: " + what);
}

/// Lists the entries of a folder whose names have a prefix, the highest version first.
Paths named(const fs::path& folder, std::string_view beginning) {
    Paths found;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder, none))
        if (entry.path().filename().native().starts_with(beginning)) found.push_back(entry.path());
    std::sort(found.begin(), found.end(), [](const fs::path& a, const fs::path& b) {
        return ::strverscmp(a.c_str(), b.c_str()) > 0;
    });
    return found;
}

void add(Paths& to, const Paths& more) {
    to.insert(to.end(), more.begin(), more.end());
}

/// Returns the package folders of the python3 on the PATH.
Paths of_pip() {
    constexpr char kAsk[] =
        "python3 -c 'import importlib.util as u, sys; sys.path = [p for p in sys.path if p]; "
        "s = u.find_spec(\"onnxruntime\"); print(*(s.submodule_search_locations if s else ()))' "
        "2> /dev/null";
    std::string folder;
    FILE* const asked = ::popen(kAsk, "r");
    if (asked == nullptr) return {};
    std::array<char, 4096> part{};
    while (std::fgets(part.data(), part.size(), asked) != nullptr) folder += part.data();
    ::pclose(asked);
    while (!folder.empty() && folder.back() == '\n') folder.pop_back();
    return folder.empty() ? Paths{} : named(fs::path(folder) / "capi", kLibrary);
}

/// Returns the package folders of node and npm: in the working directory and above, and beside the
/// node on the PATH.
Paths folders_of_npm() {
    Paths folders;
    std::error_code none;
    for (fs::path at = fs::current_path(none); !at.empty(); at = at.parent_path()) {
        folders.push_back(at / "node_modules");
        if (at == at.root_path()) break;
    }
    const char* const path = std::getenv("PATH");
    std::istringstream programs(path == nullptr ? "" : path);
    for (std::string folder; std::getline(programs, folder, ':');)
        if (fs::exists(fs::path(folder) / "node", none))
            folders.push_back(fs::path(folder).parent_path() / "lib" / "node_modules");
    folders.emplace_back("/usr/local/lib/node_modules");
    return folders;
}

Paths of_npm() {
    Paths found;
    for (const fs::path& folder : folders_of_npm())
        for (const fs::path& version : named(folder / "onnxruntime-node" / "bin", "napi-v"))
            add(found, named(version / "linux" / kNodeMachine, kLibrary));
    return found;
}

/// Finds libraries of system packages, whose names may end in any version.
Paths of_system() {
    Paths found;
    for (const char* const folder :
         {"/usr/local/lib", "/usr/lib/" ETLC_LIBRARY_ARCHITECTURE, "/usr/lib64", "/usr/lib"})
        add(found, named(folder, kLibrary));
    return found;
}

/// Finds the library that a path names: a file, or one in a folder of a release or package.
fs::path library_at(const std::string& where) {
    std::error_code none;
    if (!fs::exists(where, none)) refuse_library("there is no '" + where + "'");
    if (!fs::is_directory(where, none)) return where;
    for (const char* const inner : {"", "lib", "capi"})
        if (const Paths found = named(fs::path(where) / inner, kLibrary); !found.empty())
            return found.front();
    refuse_library("'" + where + "' holds no " + std::string(kLibrary) + kExpected);
}

using Head = ElfW(Ehdr);

/// Returns the machine of an ELF file; nothing for other files.
std::optional<Head> head_of(const fs::path& path) {
    Head head{};
    std::ifstream file(path, std::ios::binary);
    file.read(reinterpret_cast<char*>(&head), sizeof head);
    if (!file || std::memcmp(head.e_ident, ELFMAG, SELFMAG) != 0) return std::nullopt;
    return head;
}

/// Returns whether programs for both machines run on one.
bool are_alike(const Head& one, const Head& other) {
    return one.e_ident[EI_CLASS] == other.e_ident[EI_CLASS] &&
           one.e_ident[EI_DATA] == other.e_ident[EI_DATA] && one.e_machine == other.e_machine;
}

struct Opened {
    void* library = nullptr;
    std::string name;
};

Opened open(const fs::path& found) {
    const fs::path path = fs::absolute(found);  // dlopen() searches elsewhere for a bare name
    const std::string name = "'" + path.string() + "'";
    const auto head = head_of(path);
    if (!head) refuse_library(name + " is no shared library" + kExpected);
    if (!are_alike(*head, head_of("/proc/self/exe").value_or(*head)))
        refuse_library(name + " is for another processor than this etlc");
    // The table of sections is at its end; without it a signal would stop the loader.
    if (head->e_shoff + std::size_t{head->e_shnum} * head->e_shentsize > fs::file_size(path))
        refuse_library(name + " is cut: its end is missing");
    void* const library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) refuse_library(name + " cannot be loaded: " + ::dlerror());
    return {library, name};
}

/// Finds the library without a path: installed by pip, npm or the system.
Opened find() {
    for (const auto& where : {of_pip, of_npm})
        if (const Paths found = where(); !found.empty()) return open(found.front());
    for (const char* const name : {"libonnxruntime.so.1", "libonnxruntime.so"})
        if (void* const library = ::dlopen(name, RTLD_NOW | RTLD_LOCAL)) return {library, name};
    if (const Paths found = of_system(); !found.empty()) return open(found.front());
    refuse_library(
        "there is no ONNX Runtime, which runs networks: pip install onnxruntime, or npm install "
        "onnxruntime-node, or unpack a release of it and name its folder, --onnxruntime FOLDER "
        "(Debian 13: apt install libonnxruntime-dev; docs/recordings.md)");
}

struct Base {
    const ort::Function* (*table)(std::uint32_t interface);
    const char* (*version)();
};

const ort::Function* loaded = nullptr;

}  // namespace

const ort::Function* ort::table() {
    return loaded;
}

Library load_onnxruntime(const std::string& where) {
    const char* const environment = std::getenv("ETLC_ONNXRUNTIME");
    const std::string named = where.empty() && environment != nullptr ? environment : where;
    const Opened opened = named.empty() ? find() : open(library_at(named));
    auto* const base =
        reinterpret_cast<const Base* (*)()>(::dlsym(opened.library, "OrtGetApiBase"));
    if (base == nullptr) refuse_library(opened.name + " is another library" + kExpected);
    Dl_info place{};
    ::dladdr(reinterpret_cast<void*>(base), &place);
    loaded = base()->table(ort::kInterface);
    const std::string version = base()->version();
    if (loaded == nullptr) refuse_library(opened.name + " is ONNX Runtime " + version + kExpected);
    return {place.dli_fname, version};
}

}  // namespace etlc::embed::worker
