// Runs `etlc calibrate` in process, for tests of every way to a guarantee.
// Takes: the text of a spec and episodes as text. Gives: the diagnostics and the thresholds file.
// Keeps true: it runs the whole command, from files to a file.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "check/check.hpp"
#include "diag/diag.hpp"
#include "npy_bytes.hpp"

namespace etlc::tests {

/// .csv files that exist as long as this object.
class Files {
public:
    Files() = default;
    explicit Files(const std::vector<std::string>& texts) {
        for (const std::string& text : texts) add(text);
    }
    void add(const std::string& text);
    const std::vector<std::string>& paths() const { return paths_; }

private:
    std::unique_ptr<TemporaryPath> folder_ = std::make_unique<TemporaryPath>("episode");
    std::vector<std::string> paths_;
};

struct Calibrated {
    std::vector<std::string> codes;  ///< codes of the errors, each once
    std::string report;
    std::string thresholds;  ///< the file; empty after errors
};

/// `before`: the thresholds file of the predicates; empty: calibrate them now. `fitted`: the file
/// of `etlc fit`.
Calibrated calibrated(const std::string& spec, const std::vector<std::string>& episodes,
                      const std::string& before = "", const std::string& fitted = "");

/// Returns the numbers in a thresholds file, without its description of the spec.
std::string numbers(const std::string& thresholds);

/// Returns the file of `etlc fit`; empty after errors.
std::string fitted(const std::string& spec, const std::vector<std::string>& episodes);

/// Reads a spec with these files beside it, like every command.
struct Checked {
    std::optional<check::Model> model;  ///< empty: refused
    std::vector<std::string> codes;
    std::string text;  ///< messages of the errors with their notes
};
Checked checked(const std::string& spec, const std::string& thresholds,
                const std::string& fitted = "");

/// Returns the codes of the errors, each once.
std::vector<std::string> error_codes(const diag::Sink& sink);

}  // namespace etlc::tests
