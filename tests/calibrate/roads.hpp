// `etlc calibrate` in process, for tests that take every road to a guarantee.
// Takes: the text of a spec and episodes as text. Gives: what was reported, and the thresholds
// file. Keeps true: it is the whole way, from files to a file.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "check/check.hpp"
#include "diag/diag.hpp"
#include "npy_bytes.hpp"

namespace etlc::tests {

/// .csv files that are there as long as this is.
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
    std::vector<std::string> codes;  ///< of the errors, each once
    std::string report;
    std::string thresholds;  ///< the file; empty where there were errors
};

/// `before`: the thresholds file of the predicates, empty where they are calibrated now. `fitted`:
/// the file of what is fitted.
Calibrated calibrated(const std::string& spec, const std::vector<std::string>& episodes,
                      const std::string& before = "", const std::string& fitted = "");

/// The numbers in a thresholds file, without what it says of the spec.
std::string numbers(const std::string& thresholds);

/// The file that `etlc fit` makes; empty where there were errors.
std::string fitted(const std::string& spec, const std::vector<std::string>& episodes);

/// A spec with these files beside it, as every command reads it.
struct Checked {
    std::optional<check::Model> model;  ///< nothing: it is refused
    std::vector<std::string> codes;
    std::string text;  ///< of the errors and their notes
};
Checked checked(const std::string& spec, const std::string& thresholds,
                const std::string& fitted = "");

/// Codes of the errors, each once.
std::vector<std::string> error_codes(const diag::Sink& sink);

}  // namespace etlc::tests
