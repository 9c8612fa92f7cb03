// Sets of recorded episodes: where they lie, and what tells one from another.
// Takes: the --data arguments, which are files, folders and patterns. Gives: the episodes, one
// after the other. Keeps true: the order depends on the arguments and on the names of the files
// alone, not on the file system or the locale; an episode is read as a trace, a step at a time, so
// a set takes no more memory than what is open at once.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "data/traces/overlap.hpp"
#include "data/traces/trace.hpp"
#include "diag/diag.hpp"

namespace etlc::recordings {

/// A file of this name is a table of labels of the episodes beside it, never an episode.
inline constexpr std::string_view kLabelsFile = "labels.csv";

/// A part of the episodes: those from one share of them to another.
struct Part {
    double from = 0;
    double to = 1;
    bool in_order =
        false;  ///< else they are dealt by the CRC-32 of their files, and of nothing else
};

/// Which of the episodes in its arguments a call takes.
struct Chosen {
    std::string groups;  ///< pattern of the groups of .h5 files that are episodes; empty: the files
    Part part;
};

/// Returns the episodes of all arguments. An argument is a file; a data set, which stands for its
/// episodes, FOLDER:NUMBER (FOLDER:FIRST:END for a range), with warnings about incomplete ones; a
/// folder, which stands for the traces in it; or a pattern of the shell ("runs/*/ep?.npz"). The
/// episodes of each argument are sorted by path, bytewise; repeated paths are dropped. Each group
/// of an .h5 file that matches ("data/*") is an episode, FILE:GROUP for open_trace. Reports an
/// argument or a part without episodes, E0801.
std::vector<std::string> find_episodes(const std::vector<std::string>& arguments,
                                       const Chosen& chosen, diag::Sink& sink);

/// An input whose samples distinguish episodes.
struct HashedInput {
    std::string name;             ///< name under which it is compared
    std::uint32_t dimension = 1;  ///< numbers per sample
    bool tells_alone = false;     ///< one sample is evidence; else only a run of samples is
};

/// Hashes the content of an episode step by step: 64 bits as 16 hex digits, the same on every
/// machine and for the same float32 values in any file format. Order and lengths count; names and
/// the file do not.
class EpisodeHash {
public:
    explicit EpisodeHash(std::vector<HashedInput> inputs);

    /// Adds a step: a sample for each input, finite and without negative zeros; empty: missing.
    void add(const std::vector<std::vector<float>>& samples);
    /// Returns the hash of all steps so far.
    std::string text() const;
    /// Returns the content of each input so far.
    data::EpisodeContent content() const;

private:
    std::vector<HashedInput> inputs_;
    std::vector<data::ContentReader> readers_;  ///< per input
    std::vector<std::uint32_t> bits_;           ///< one step
    std::uint64_t steps_ = 0;
    std::uint64_t hash_ = 0;
};

}  // namespace etlc::recordings
