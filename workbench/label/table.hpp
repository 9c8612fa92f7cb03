// A table of labels that `etlc label` rewrites after each key.
// Takes: the file, and the new labels of a predicate in an episode. Gives: the file with these.
// Keeps true: rows about anything else stay, and stay in their order; the file is the old one or
// the new one at any moment, and on the disk when a write returns; a file that another program has
// changed is not overwritten: two calls of etlc exclude each other from the comparison until the
// new file has its name, other programs only before it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "diag/diag.hpp"
#include "episodes/labels/labels.hpp"

namespace etlc::label {

// The labels of a predicate in an episode, and what a key does to them.
// Takes: the labels before, the key, and the step under the cursor. Gives: the labels after. Keeps
// true: intervals are sorted, none is empty or beyond the episode, and no two overlap. An interval
// that begins before another one touches it until the next key, which may be its end.

/// Steps from `start` up to but excluding `end`, at which the predicate holds, or nobody knows.
struct Interval {
    std::uint64_t start = 0;
    std::uint64_t end = 0;
    episodes::Label label = episodes::Label::yes;

    bool operator==(const Interval&) const = default;
};

/// The intervals of a predicate; it is false elsewhere. Nothing: nobody has labelled it.
using Marks = std::optional<std::vector<Interval>>;

/// In the order of the words of key_named().
enum class Key : std::uint8_t {
    begin,    ///< it holds from this step on
    end,      ///< it holds up to and including this step
    unknown,  ///< nobody knows about the interval at this step, or somebody does again
    remove,   ///< the interval at this step goes
    never,    ///< it holds at no step
    forget    ///< nobody has looked
};

/// Returns the key of "begin", "end", ...
std::optional<Key> key_named(std::string_view word);

/// Returns the intervals with those joined that touch and have the same label.
std::vector<Interval> joined(const std::vector<Interval>& intervals);

/// Returns the labels after a key. `step` is less than `steps`, the length of the episode.
Marks after_key(const Marks& before, Key key, std::uint64_t step, std::uint64_t steps);

/// The labels of a predicate in an episode.
struct LabelsOf {
    std::string episode;  ///< its path
    std::string name;     ///< its name for new rows
    std::string predicate;
    std::uint64_t steps = 0;
    Marks marks;
};

class Table {
public:
    /// Reads the file, which need not exist. `episodes`: those that it may name. A table in seconds
    /// has steps of `step_seconds`. Failures: E0801, E0803, E0822, E0860; they do not name the
    /// path.
    static diag::Result<Table> read(std::string path, const std::vector<std::string>& episodes,
                                    double step_seconds);

    const std::string& path() const { return path_; }
    /// Returns whether the file differs from what was last read or written.
    bool has_changed() const;
    /// Writes the file with these labels. After a failure it is as it was.
    std::optional<diag::Failure> write(const std::vector<LabelsOf>& labels);

private:
    struct Row : episodes::LabelRow {
        std::string of;  ///< path of the episode; empty: another one
    };
    using Rows = std::vector<Row>;

    Table() = default;
    void put(const LabelsOf& labels, Rows& rows) const;
    std::string text_of(const Rows& rows) const;
    std::string bound(double value) const;

    std::string path_;
    std::optional<std::string> bytes_;  ///< of the file; nothing: there is none
    bool in_seconds_ = false;
    double step_seconds_ = 0;
    Rows rows_;
};

}  // namespace etlc::label
