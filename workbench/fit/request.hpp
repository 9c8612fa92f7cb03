// What `etlc fit` is asked for.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "data/recordings/open.hpp"

namespace etlc::fit {

struct Request {
    std::vector<std::string> episodes;  ///< as data::find_episodes gives them
    data::NamesInFile names;
    /// The reason for which overlaps are passed over; empty: they are not.
    std::string allow_overlap;
    unsigned jobs = 0;    ///< threads; 0: as many as the machine has
    std::string version;  ///< of etlc
    /// Called now and then, by any thread, never by two at once.
    std::function<void(std::size_t done, std::size_t total)> progress;
    /// Bytes of frames that are kept in memory, all episodes together; the others are read again.
    std::size_t most_kept = std::size_t{256} << 20U;
};

}  // namespace etlc::fit
