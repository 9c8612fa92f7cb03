// A table of labels that `etlc label` rewrites after each key.
// Takes: the file, and the new labels of a predicate in an episode. Gives: the file with these.
// Keeps true: rows about anything else stay, and stay in their order; the file is the old one or
// the new one at any moment, and on the disk when a write returns; a file that another program has
// changed is not overwritten: two calls of etlc exclude each other from the comparison until the
// new file has its name, other programs only before it.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "diag/diag.hpp"
#include "episodes/labels/table.hpp"
#include "label/marks.hpp"

namespace etlc::label {

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
    std::string group_of(const std::string& episode) const;
    std::string text_of(const Rows& rows) const;
    std::string bound(double value) const;

    std::string path_;
    std::optional<std::string> bytes_;  ///< of the file; nothing: there is none
    bool in_seconds_ = false;
    double step_seconds_ = 0;
    Rows rows_;
};

}  // namespace etlc::label
