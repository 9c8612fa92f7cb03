// Data flows one way through the compiler, and so do its includes and its CMake targets.
#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tree.hpp"

namespace etlc::house {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

/// The layers, in order: each builds on those before it.
const std::vector<std::string> kBuildings = {"base", "compiler", "workbench"};

/// The tables of docs/contributing/compiler.md and workbench.md: the stages that a stage builds on.
/// The relation is transitive; every stage also sees source and diag.
const std::map<std::string, Names> kArrows = {
    {"source", {}},
    {"diag", {"source"}},
    {"ast", {"source"}},
    {"data", {"diag"}},
    {"artifacts", {"data"}},
    {"parse", {"ast", "diag"}},
    {"check", {"ast", "data", "artifacts"}},
    {"recordings", {"artifacts"}},
    {"embed", {"check", "recordings"}},
    {"reference", {"check"}},
    {"ir", {"check"}},
    {"opt", {"ir"}},
    {"plan", {"opt"}},
    {"execute", {"plan"}},
    {"emit", {"plan"}},
    {"explain", {"execute"}},
    {"compile", {"parse", "plan"}},
    {"episodes", {"execute", "compile", "recordings"}},
    {"fit", {"episodes"}},
    {"calibrate", {"episodes"}},
    {"evaluate", {"episodes"}},
    {"annotate", {"evaluate"}},
    {"report", {"explain", "fit", "evaluate"}},
    {"label", {"calibrate", "report"}},
    {"watch", {"embed", "label"}},
    {"prove", {"emit", "reference", "compile"}},
    {"library", {"explain", "compile", "recordings"}},
    {"lsp", {"library"}},
    {"driver",
     {"library", "emit", "explain", "embed", "fit", "calibrate", "evaluate", "annotate", "report",
      "label", "watch", "lsp", "prove"}},
};

/// Stages after check, which must not include ast or parse although the relation would allow it.
const Names kBelowTheModel = {"reference", "ir",       "opt", "plan",      "execute", "emit",
                              "explain",   "episodes", "fit", "calibrate", "evaluate"};

/// The reference evaluator shares no arithmetic with the stages that it checks.
const Names kWithoutRuntime = {"reference"};

/// Libraries that only one or two folders may use.
const std::map<std::string, Names> kOwners = {{"antlr4", {"parse"}},
                                              {"hdf5", {"recordings"}},
                                              {"H5", {"recordings"}},
                                              {"zip", {"data"}},
                                              {"snappy", {"recordings"}},
                                              {"zstd", {"annotate", "recordings"}},
                                              {"zlib", {"recordings", "report"}},
                                              {"httplib", {"label"}},
                                              {"CLI", {"driver"}}};

/// Everything that generated code may need of a C library.
const Names kFirmwareHeaders = {"stdint.h", "stddef.h", "float.h", "string.h", "math.h"};

/// Headers of the runtime for programs on a host, which no generated code includes, and the headers
/// of the C++ library that each may use.
const std::map<std::string, Names> kHosted = {
    {"dynamic.hpp", {}},
    {"dynamic_enclosed.hpp", {}},
    {"error_bounds.hpp", {}},
    {"footprint.hpp", {}},
    {"mapped_targets.hpp", {"errno.h", "fcntl.h", "sys/mman.h", "sys/stat.h", "unistd.h"}},
    {"table.hpp", {}}};

/// Folder of the runtime -> the folders that it may include; "etlmon" has the files outside
/// folders.
const std::map<std::string, Names> kHouses = {
    {"etlmon", {"etlmon"}},
    {"temporal", {"etlmon", "temporal"}},
    {"distance", {"etlmon", "temporal", "distance"}},
    {"past", {"etlmon", "temporal", "past"}},
    {"params", {"etlmon", "distance", "params"}},
    {"vectors", {"etlmon", "distance", "vectors"}},
    {"hosted", {"etlmon", "temporal", "distance", "past", "hosted"}}};

/// The places where firmware's half of the runtime includes the other.
const Names kGates = {"views.hpp", "best.hpp"};

Names reachable(const std::string& folder) {
    Names seen = {folder, "source"};
    if (folder != "source" && folder != "ast") seen.insert("diag");
    for (const std::string& next : kArrows.at(folder)) seen.merge(reachable(next));
    return seen;
}

Names allowed(const std::string& folder) {
    Names stages = reachable(folder);
    if (kBelowTheModel.contains(folder)) {
        stages.erase("ast");
        stages.erase("parse");
    }
    return stages;
}

/// Returns "ast" for "ast/ast.hpp" and "antlr4" for "antlr4-runtime.h".
std::string first_word(const std::string& include) {
    return include.substr(0, include.find_first_of("/.-_"));
}

/// Returns the stage of a file: its folder in the layer, or its name outside folders,
/// "compiler/compile.cpp".
std::string folder_of(const fs::path& file) {
    const fs::path part = *std::next(file.begin());
    return std::distance(file.begin(), file.end()) == 2 ? part.stem() : part;
}

/// Returns whether an include names a file of a stage: those of the C++ library are without folder.
bool names_stage(const std::string& include) {
    const bool in_folder = include.find('/') != std::string::npos;
    return (in_folder || include == "compile.hpp") && kArrows.contains(first_word(include));
}

/// Returns the C++ sources of all layers.
std::vector<fs::path> sources() {
    std::vector<fs::path> found;
    for (const std::string& building : kBuildings) {
        for (const auto& file : cpp_files(building)) found.push_back(file);
    }
    return found;
}

/// folder -> the index of its layer in kBuildings.
const std::map<std::string, std::size_t>& storeys() {
    static const std::map<std::string, std::size_t> found = [] {
        std::map<std::string, std::size_t> result;
        for (std::size_t i = 0; i < kBuildings.size(); ++i) {
            for (const auto& file : files(kBuildings[i])) {
                if (file.extension() != ".txt") result[folder_of(file)] = i;
            }
        }
        return result;
    }();
    return found;
}

/// stage -> the stages that its CMakeLists.txt links, directly or indirectly.
Names linked(const std::string& folder) {
    static const std::regex kDepends(R"(\bDEPENDS\b([^)]*))");
    static const std::regex kWord(R"([A-Za-z0-9_:]+)");
    const fs::path layer = kBuildings[storeys().at(folder)];
    const bool is_folder = fs::exists(fs::path(ETLC_SOURCE_DIR) / layer / folder);
    const std::string text = content(layer / (is_folder ? folder : "") / "CMakeLists.txt");
    Names found = {folder};
    for (std::sregex_iterator call(text.begin(), text.end(), kDepends);
         call != std::sregex_iterator(); ++call) {
        const std::string list = (*call)[1];
        for (std::sregex_iterator word(list.begin(), list.end(), kWord);
             word != std::sregex_iterator(); ++word) {
            if (word->str() == "LIBRARIES" || word->str() == "SOURCES") break;
            if (kArrows.contains(word->str())) found.merge(linked(word->str()));
        }
    }
    return found;
}

TEST(Arrows, EveryFolderIsInTheTable) {
    for (const auto& [folder, storey] : storeys())
        EXPECT_TRUE(kArrows.contains(folder)) << kBuildings[storey] << "/" << folder;
}

TEST(Arrows, BuildingsStandOnThoseBelow) {
    for (const auto& [folder, arrows] : kArrows) {
        for (const std::string& to : arrows) {
            EXPECT_LE(storeys().at(to), storeys().at(folder)) << folder << " builds on " << to;
        }
    }
}

TEST(Arrows, StagesIncludeOnlyWhatTheyBuildOn) {
    for (const auto& file : sources()) {
        const std::string folder = folder_of(file);
        const Names stages = allowed(folder);
        for (const std::string& include : includes(file)) {
            const std::string to = first_word(include);
            if (names_stage(include)) {
                EXPECT_TRUE(stages.contains(to)) << file << " includes " << include;
            }
            if (to == "etlmon") {
                EXPECT_FALSE(kWithoutRuntime.contains(folder)) << file << " includes " << include;
            }
            if (const auto owner = kOwners.find(to); owner != kOwners.end()) {
                EXPECT_TRUE(owner->second.contains(folder)) << file << " includes " << include;
            }
            EXPECT_NE(to, "tests") << file << " includes " << include;
        }
    }
}

TEST(Arrows, TargetsLinkWhatTheirFilesInclude) {
    for (const auto& file : sources()) {
        const std::string folder = folder_of(file);
        const Names stages = linked(folder);
        for (const std::string& include : includes(file)) {
            const std::string to = first_word(include);
            if (!names_stage(include)) continue;
            EXPECT_TRUE(stages.contains(to))
                << file << " includes " << include << ", which the DEPENDS of " << folder
                << " do not give";
        }
    }
}

TEST(Arrows, TargetsLinkOnlyWhatTheyBuildOn) {
    for (const auto& [folder, arrows] : kArrows) {
        const Names stages = reachable(folder);
        for (const std::string& to : linked(folder)) {
            EXPECT_TRUE(stages.contains(to)) << folder << " links " << to;
        }
    }
}

/// folder -> the folders that its files include, "check/points" -> "check/model"; a folder and its
/// subfolders count separately.
std::map<std::string, Names> folders_included() {
    std::map<std::string, Names> found;
    for (const auto& file : sources()) {
        const fs::path building = *file.begin();
        const std::string folder = file.parent_path().lexically_relative(building);
        for (const std::string& include : includes(file)) {
            if (!fs::exists(fs::path(ETLC_SOURCE_DIR) / building / include)) continue;
            const std::string to = fs::path(include).parent_path();
            if (to != folder) found[folder].insert(to);
        }
    }
    return found;
}

TEST(Arrows, FoldersHaveNoCircles) {
    std::map<std::string, Names> above = folders_included();
    ASSERT_GT(above.size(), 40U);
    // Remove folders that include no remaining folder, until none can be removed.
    for (bool changed = true; changed;) {
        changed = false;
        for (auto folder = above.begin(); folder != above.end();) {
            std::erase_if(folder->second, [&](const auto& to) { return !above.contains(to); });
            changed = changed || folder->second.empty();
            folder = folder->second.empty() ? above.erase(folder) : std::next(folder);
        }
    }
    for (const auto& [folder, included] : above)
        for (const std::string& to : included)
            ADD_FAILURE() << folder << " includes " << to << ", on or above a circle";
}

TEST(Arrows, TheRuntimeHasTwoHouses) {
    std::size_t gates = 0;
    for (const auto& file : files("runtime")) {
        if (file.extension() != ".hpp" && file.extension() != ".inc") continue;
        const std::string folder = file.parent_path().filename();
        ASSERT_TRUE(kHouses.contains(folder)) << file;
        for (const std::string& include : includes(file)) {
            if (!include.starts_with("etlmon/")) continue;
            const std::string to = std::filesystem::path(include).parent_path().filename();
            if (to == "vectors" && folder != to) {
                EXPECT_TRUE(kGates.contains(file.filename())) << file << " includes " << include;
                ++gates;
            } else {
                EXPECT_TRUE(kHouses.at(folder).contains(to)) << file << " includes " << include;
            }
        }
    }
    EXPECT_EQ(gates, kGates.size());
}

TEST(Arrows, TheRuntimeNeedsFiveHeadersOfC) {
    for (const auto& file : cpp_files("runtime")) {
        const auto hosted = kHosted.find(file.filename());
        for (const std::string& include : includes(file)) {
            const bool ours =
                include.starts_with("etlmon/") || include.starts_with("etlmon needs C++17");
            if (hosted == kHosted.end()) {
                EXPECT_TRUE(ours || kFirmwareHeaders.contains(include))
                    << file << " includes " << include;
                EXPECT_FALSE(ours && kHosted.contains(std::filesystem::path(include).filename()))
                    << file << " includes " << include;
            } else {
                EXPECT_TRUE(ours || kFirmwareHeaders.contains(include) ||
                            hosted->second.contains(include))
                    << file << " includes " << include;
            }
        }
    }
}

}  // namespace
}  // namespace etlc::house
