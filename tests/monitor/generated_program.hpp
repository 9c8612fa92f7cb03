// Generated classes in a separate program: `etlc` makes the headers, a compiler the program, and
// traces go through it. Takes: specs. Gives: the output of the compiled classes. Keeps true:
// everything is in one separate folder; a failing tool fails the current test with its message.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "generated_wire.hpp"

namespace etlc::tests {

/// How a program is built and run.
struct Build {
    std::string name;      ///< name of the test that is instantiated with it
    std::string compiler;  ///< g++, clang++
    std::string flags;
    bool counts_malloc = false;  ///< neither with AddressSanitizer nor in a static program
    std::string emulator{};      ///< emulator for the program; empty: this machine runs it
};
inline void PrintTo(const Build& build, std::ostream* out) {
    *out << build.name;
}

inline const Build kGccSanitized{"GccSanitized", "g++", ETLC_GCC_SANITIZERS};
inline const Build kClangSanitized{"ClangSanitized", "clang++", ETLC_CLANG_SANITIZERS};
inline const Build kGccFastMath{"GccFastMath", "g++", "-O3 -ffast-math", true};
inline const Build kClangFastMath{"ClangFastMath", "clang++", "-O3 -ffast-math", true};
inline const Build kAarch64{"Aarch64", "aarch64-linux-gnu-g++", "-O2 -static", false,
                            "qemu-aarch64"};

/// How the classes of a program are made, and the code that steps them.
struct Classes {
    std::string options{};                    ///< more options of etlc
    std::string session{"harness::Session"};  ///< or another file of driver/
};

class GeneratedProgram {
public:
    /// Makes an empty folder of that name below the build folder.
    explicit GeneratedProgram(const std::string& name, Classes classes = {});

    /// Makes `etlc` write SPEC.hpp. Specs of one program have different names. Returns false on
    /// failure.
    /// failed.
    bool add(const check::Model& model, check::Values values = check::Values::robustness,
             const std::string& thresholds = "");
    /// Compiles all headers, in two translation units that share one of them.
    bool compile(const Build& build);

    struct Result {
        std::vector<Answer> answers;
        std::uint64_t allocations = 0;  ///< while monitors are stepped, finished or reset
    };
    Result run(const std::vector<Request>& requests, const std::string& arguments = "");

    /// The output of the program, as the session writes it.
    std::optional<std::string> answers(const std::vector<Request>& requests,
                                       const std::string& arguments = "");

    /// The folder of SPEC.etl and its thresholds.
    const std::filesystem::path& folder() const { return folder_; }
    const check::Model& model(std::size_t spec) const { return models_[spec]; }
    std::size_t size() const { return models_.size(); }

private:
    std::filesystem::path folder_;
    Classes classes_;
    std::vector<check::Model> models_;
    std::vector<bool> explain_;  ///< by model
    std::string emulator_;

    bool command(const std::string& line);
};

}  // namespace etlc::tests
