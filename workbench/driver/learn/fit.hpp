// `etlc fit`: spec and demonstrations in, file of fitted things out.
// Takes: the spec's text. Gives: the file, and a report on standard output, or on standard error
// where the file goes to standard output. Keeps true: the file appears whole or not at all.
#pragma once

#include <string>
#include <vector>

#include "artifacts/fitted.hpp"
#include "check/check.hpp"
#include "diag/diag.hpp"
#include "fit/readings.hpp"
#include "source/source.hpp"

namespace etlc::driver {

struct FitRequest {
    std::vector<std::string> data;  ///< files, folders and patterns
    std::string groups;             ///< of .h5 files that are episodes
    fit::Request fit;               ///< its episodes, version and progress are set here
    std::string output;             ///< empty: beside the spec
    std::string embedded;           ///< the file of embeddings; empty: beside the spec
    std::vector<check::Setting> settings;
    /// Prints which distances would separate these predicates, or all, and writes no file.
    bool suggest = false;
    std::vector<std::string> predicates;
    bool json = false;
};

/// False where the sink now says why not.
bool fit(const source::File& file, const FitRequest& request, diag::Sink& sink);

/// Where what is fitted in the model comes from; empty where nothing is. `given`: of --fitted.
fitted::File fitted_file(const check::Model& model, const std::string& spec,
                         const std::string& given);

}  // namespace etlc::driver
