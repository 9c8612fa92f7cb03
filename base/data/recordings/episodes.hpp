// Sets of recorded episodes: where they lie, and what tells one from another.
// Takes: the --data arguments, which are files, folders and patterns. Gives: the episodes, one
// after the other. Keeps true: the order depends on the arguments and on the names of the files
// alone, not on the file system or the locale; an episode is read as a trace, a step at a time, so
// a set takes no more memory than what is open at once.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "data/traces/overlap.hpp"
#include "data/traces/trace.hpp"
#include "diag/diag.hpp"

namespace etlc::data {

/// Every episode of the arguments: a file as it stands; of a data set its episodes, as
/// FOLDER:NUMBER (FOLDER:FIRST:END names some of them), where what it lacks is a warning; of a
/// folder the files in it whose ending is that of a trace; of a pattern ("runs/*/ep?.npz", as the
/// shell's) the files that match. Each argument's are sorted by path, bytewise; a path that comes
/// up again stands once. `groups`: of .h5 files each group that matches is an episode ("data/*"),
/// as FILE:GROUP, which open_trace takes; empty: the file is one. An argument without an episode is
/// reported, E0801.
std::vector<std::string> find_episodes(const std::vector<std::string>& arguments,
                                       const std::string& groups, diag::Sink& sink);

/// An input whose samples tell episodes apart.
struct HashedInput {
    std::string name;             ///< what it is compared under
    std::uint32_t dimension = 1;  ///< numbers of a sample
    bool tells_alone = false;     ///< one sample is evidence; else a run of them is
};

/// The content of an episode, read along: 64 bits as 16 hex digits, the same on every machine and
/// for the same float32 values in any file format. Order and lengths count; names and the file do
/// not.
class EpisodeHash {
public:
    explicit EpisodeHash(std::vector<HashedInput> inputs);

    /// The next step: of each input the sample, finite and no negative zero; empty: missing.
    void add(const std::vector<std::vector<float>>& samples);
    /// Of the steps so far.
    std::string text() const;
    /// The same of each input.
    EpisodeContent content() const;

private:
    std::vector<HashedInput> inputs_;
    std::vector<ContentReader> readers_;  ///< per input
    std::vector<std::uint32_t> bits_;     ///< of one step
    std::uint64_t steps_ = 0;
    std::uint64_t hash_ = 0;
};

}  // namespace etlc::data
