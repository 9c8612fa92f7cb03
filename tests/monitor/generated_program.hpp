// Generated classes in a program of their own: `etlc` makes the headers, a compiler the program, traces go through it.
// Takes: specs. Gives: what the compiled classes say. Keeps true: everything lies in one folder of its own; a step that
// fails fails the current test with the words of the tool that failed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "check/model.hpp"
#include "generated_wire.hpp"

namespace etlc::tests {

struct Build {
    std::string compiler;  ///< g++, clang++
    std::string flags;
    bool counts_malloc = false;  ///< not beside AddressSanitizer
};

class GeneratedProgram {
public:
    /// Makes an empty folder of that name below the build folder.
    explicit GeneratedProgram(const std::string& name);

    /// Has `etlc` write SPEC.hpp. Specs of one program have different names. False where that failed.
    bool add(const check::Model& model, check::Values values = check::Values::robustness,
             const std::string& thresholds = "");
    /// All headers, in two translation units that share one of them.
    bool compile(const Build& build);

    struct Result {
        std::vector<Answer> answers;
        std::uint64_t allocations = 0;  ///< while monitors were stepped, finished or reset
    };
    Result run(const std::vector<Request>& requests, const std::string& arguments = "");

    const check::Model& model(std::size_t spec) const { return models_[spec]; }
    std::size_t size() const { return models_.size(); }

private:
    std::filesystem::path folder_;
    std::vector<check::Model> models_;

    bool command(const std::string& line);
};

}  // namespace etlc::tests
