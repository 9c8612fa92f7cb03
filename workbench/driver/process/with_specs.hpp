// Commands that read specs: what they do, and how their findings are told.
// Takes: paths, and the work. Gives: the exit status. Keeps true: what was found is told whatever
// happens, a lack of memory too.
#pragma once

#include <algorithm>
#include <cstdint>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "data/files/file.hpp"
#include "diag/diag.hpp"
#include "driver/process/process.hpp"
#include "driver/process/telling.hpp"
#include "library/open.hpp"
#include "source/source.hpp"

namespace etlc::driver {

enum class SpecWarnings : std::uint8_t { told, dropped };

struct Telling {
    std::string form;  ///< "text" or "json"
    bool warnings_are_errors = false;
    SpecWarnings of_spec = SpecWarnings::told;
};

/// Reads the specs and does `work(files, sinks)` with them.
template <class Work>
int with_specs(const std::vector<std::string>& paths, const Telling& telling, const Work& work) {
    std::vector<diag::Sink> sinks(paths.size(), diag::Sink(telling.warnings_are_errors));
    std::vector<source::File> files(paths.size());
    // What was found so far is told as well.
    const auto report_lack = [&] {
        sinks[0].report(data::in_file(
            {diag::Code::out_of_memory, "there is not enough memory for this"}, paths[0]));
    };
    try {
        bool all_read = true;
        for (std::size_t i = 0; i < paths.size(); ++i)
            all_read = library::read_spec(paths[i], files[i], sinks[i]) && all_read;
        if (all_read) work(files, sinks);
    } catch (const std::bad_alloc&) {
        report_lack();
    } catch (const std::length_error&) {
        report_lack();
    }
    int status = kDone;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        if (telling.of_spec == SpecWarnings::dropped) sinks[i].drop_warnings_of_spec();
        status = std::max(status, conclude(telling.form, files[i], sinks[i]));
    }
    return status;
}

}  // namespace etlc::driver
