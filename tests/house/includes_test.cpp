// Each file includes the precompiled headers that it uses, itself or through one of our headers:
// the compiler has already read these and does not notice a missing include.
#include <gtest/gtest.h>

#include <filesystem>
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

/// Header -> words that belong to it, as far as they are used here.
const std::map<std::string, std::vector<std::string>> kWords = {
    {"algorithm",
     {"std::all_of(",      "std::any_of(",      "std::binary_search(", "std::clamp(",
      "std::copy(",        "std::count(",       "std::count_if(",      "std::equal(",
      "std::fill(",        "std::find(",        "std::find_if(",       "std::lower_bound(",
      "std::max(",         "std::max_element(", "std::min(",           "std::min_element(",
      "std::none_of(",     "std::nth_element(", "std::reverse(",       "std::sort(",
      "std::stable_sort(", "std::transform(",   "std::unique(",        "std::upper_bound("}},
    {"array", {"std::array<"}},
    {"cmath",
     {"std::ceil(", "std::exp(", "std::fabs(", "std::floor(", "std::isfinite(", "std::isinf(",
      "std::isnan(", "std::ldexp(", "std::log(", "std::nextafter(", "std::pow(", "std::sqrt("}},
    {"cstdint",
     {"std::int8_t", "std::int32_t", "std::int64_t", "std::uint8_t", "std::uint16_t",
      "std::uint32_t", "std::uint64_t"}},
    {"filesystem", {"std::filesystem"}},
    {"fmt/format.h", {"fmt::format(", "fmt::format_to(", "fmt::memory_buffer"}},
    {"fstream", {"std::ifstream", "std::ofstream"}},
    {"functional", {"std::function<", "std::hash<"}},
    {"gtest/gtest.h", {"TEST(", "TEST_F(", "TEST_P(", "EXPECT_EQ(", "ASSERT_TRUE("}},
    {"map", {"std::map<", "std::multimap<"}},
    {"memory", {"std::make_shared<", "std::make_unique<", "std::shared_ptr<", "std::unique_ptr<"}},
    {"optional", {"std::nullopt", "std::optional<"}},
    {"random", {"std::mt19937", "std::normal_distribution", "std::uniform_int_distribution"}},
    {"set", {"std::set<"}},
    {"string", {"std::string ", "std::string&", "std::to_string("}},
    {"string_view", {"std::string_view"}},
    {"unordered_map", {"std::unordered_map<"}},
    {"variant", {"std::get_if<", "std::holds_alternative<", "std::variant<", "std::visit("}},
    {"vector", {"std::vector<"}},
};

Names precompiled(const fs::path& cmake_file) {
    static const std::regex kCall(R"(target_precompile_headers\(\w+ PRIVATE([^)]*)\))");
    static const std::regex kHeader("<([^>]+)>");
    const std::string text = content(cmake_file);
    Names found;
    if (std::smatch call; std::regex_search(text, call, kCall)) {
        const std::string list = call[1];
        for (std::sregex_iterator header(list.begin(), list.end(), kHeader);
             header != std::sregex_iterator(); ++header)
            found.insert((*header)[1]);
    }
    return found;
}

/// Returns our file that an include names, if any.
fs::path ours(const fs::path& from, const std::string& include) {
    for (const fs::path& folder :
         {from.parent_path(), fs::path("base"), fs::path("compiler"), fs::path("workbench"),
          fs::path("runtime/include"), fs::path("tests/monitor"), fs::path("tests/unit"),
          fs::path("examples/dubins")}) {
        const fs::path file = (folder / include).lexically_normal();
        if (fs::exists(fs::path(ETLC_SOURCE_DIR) / file)) return file;
    }
    return {};
}

/// Returns the system headers that a file includes, itself or through our headers.
void gather(const fs::path& file, std::set<fs::path>& seen, Names& headers) {
    if (!seen.insert(file).second) return;
    for (const std::string& include : includes(file)) {
        if (const fs::path header = ours(file, include); !header.empty())
            gather(header, seen, headers);
        else
            headers.insert(include);
    }
}

/// Removes everything after // in a line.
std::string code(const fs::path& file) {
    static const std::regex kComment("//[^\n]*");
    return std::regex_replace(content(file), kComment, "");
}

void expect_included(const std::string& cmake_file, const std::string& folder) {
    const Names precompiled_headers = precompiled(cmake_file);
    ASSERT_GT(precompiled_headers.size(), 5U) << cmake_file;
    for (const std::string& header : precompiled_headers)
        ASSERT_TRUE(kWords.contains(header)) << header << " of " << cmake_file;
    for (const auto& file : cpp_files(folder)) {
        std::set<fs::path> seen;
        Names headers;
        gather(file, seen, headers);
        const std::string text = code(file);
        for (const std::string& header : precompiled_headers) {
            if (headers.contains(header)) continue;
            for (const std::string& word : kWords.at(header))
                EXPECT_EQ(text.find(word), std::string::npos)
                    << file << " uses " << word << " without <" << header << ">";
        }
    }
}

TEST(Includes, FilesOfTheCompilerIncludeWhatTheyUse) {
    for (const std::string building : {"base", "compiler", "workbench"})
        expect_included("cmake/Stages.cmake", building);
}

TEST(Includes, TestsIncludeWhatTheyUse) {
    for (const std::string folder :
         {"calibrate", "evaluate", "examples", "monitor", "spec", "unit"})
        expect_included("tests/CMakeLists.txt", "tests/" + folder);
}

}  // namespace
}  // namespace etlc::house
