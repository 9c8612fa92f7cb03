// The specs of this project, as inputs of tests.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "diag/diag.hpp"
#include "parse/parse.hpp"

namespace etlc::lsp {

/// Returns the texts without syntax errors.
inline std::vector<std::string> good_specs() {
    std::vector<std::string> all;
    for (const char* folder : {"/tests", "/examples", "/bench"}) {
        std::set<std::filesystem::path> paths;
        for (const auto& entry :
             std::filesystem::recursive_directory_iterator(std::string(ETLC_SOURCE_DIR) + folder))
            if (entry.path().extension() == ".etl") paths.insert(entry.path());
        for (const auto& path : paths) {
            std::ifstream file(path, std::ios::binary);
            std::string text((std::istreambuf_iterator<char>(file)), {});
            diag::Sink sink;
            (void)parse::parse(source::File("", text), sink);
            if (!sink.has_errors() && text.size() < 20'000) all.push_back(std::move(text));
        }
    }
    return all;
}

}  // namespace etlc::lsp
