// The labels of a call while somebody makes them: what a key does, what undo takes back, and the
// tables on disk. It knows nothing of pages and requests.
// Keeps true: the tables hold what the desk says, whenever a function returns; where they cannot be
// written, the desk is as it was.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "episodes/labels/labels.hpp"
#include "label/table.hpp"

namespace etlc::label {

using check::Index;

struct Episode {
    std::string path;
    std::string name;  ///< in tables
    std::uint64_t steps = 0;
    std::size_t table = 0;          ///< index of its table
    std::vector<bool> is_recorded;  ///< per predicate: the recording has labels, which stay
};

/// Returns the predicates that somebody has to label: named ones for which the spec has no truth
/// and which are not their own, such as `x < 1`. If there are none, all named ones.
std::vector<Index> predicates_to_label(const check::Model& model);

struct DeskRequest {
    std::vector<std::string> episodes;  ///< as recordings::find_episodes gives them
    recordings::NamesInFile names;
    std::string table;  ///< empty: labels.csv beside the episodes
};

class Desk {
public:
    /// Reads the episodes and their labels. The model outlives the desk. Returns nothing after an
    /// error, which it reports.
    static std::optional<Desk> open(const check::Model& model, DeskRequest request,
                                    diag::Sink& sink);

    const std::vector<Index>& predicates() const { return predicates_; }
    const std::string& predicate(std::size_t p) const;
    const std::vector<Episode>& episodes() const { return episodes_; }
    const std::vector<std::string>& tables() const { return paths_; }
    const Marks& marks(std::size_t episode, std::size_t p) const { return marks_[episode][p]; }
    /// Returns whether all predicates have labels.
    bool is_labelled(std::size_t episode) const;
    /// Returns a number that grows with each change.
    std::uint64_t version() const { return version_; }

    /// Labels a predicate; the failure says why the table does not have it.
    std::optional<diag::Failure> press(std::size_t episode, std::size_t p, Key key,
                                       std::uint64_t step);
    /// Labels the predicates of an episode that nobody has labelled; `proposed`: per predicate.
    std::optional<diag::Failure> accept(std::size_t episode, const std::vector<Marks>& proposed);
    /// Takes the last change back, or makes the last one again that was taken back. Returns the
    /// episode that it was about; nothing without a change.
    diag::Result<std::optional<std::size_t>> undo() { return take_back(changes_, undone_); }
    diag::Result<std::optional<std::size_t>> redo() { return take_back(undone_, changes_); }
    /// Returns whether another program has changed a table.
    bool have_tables_changed() const;
    /// Reads the tables again, after another program has changed them. Nothing can be undone then,
    /// or redone.
    std::optional<diag::Failure> reload();

private:
    /// Labels before a change, by predicate.
    struct Change {
        std::size_t episode = 0;
        std::vector<std::pair<std::size_t, Marks>> before;
    };

    Desk(const check::Model& model, DeskRequest request);

    bool measure(diag::Sink& sink);
    void place();
    bool read(diag::Sink& sink);
    std::vector<diag::Result<Table>> read_tables() const;
    std::shared_ptr<const episodes::LabelSet> read_labels(diag::Sink& sink) const;
    bool take(const episodes::LabelSet* labels, diag::Sink& sink);
    std::optional<diag::Failure> put(std::size_t episode,
                                     const std::vector<std::pair<std::size_t, Marks>>& labels);
    std::optional<diag::Failure> change(std::size_t episode,
                                        std::vector<std::pair<std::size_t, Marks>> labels);
    diag::Result<std::optional<std::size_t>> take_back(std::vector<Change>& from,
                                                       std::vector<Change>& to);

    const check::Model* model_;
    DeskRequest request_;
    std::vector<Index> predicates_;
    std::vector<Episode> episodes_;
    std::vector<std::string> paths_;  ///< of the tables
    std::vector<Table> tables_;
    std::vector<std::vector<Marks>> marks_;  ///< by episode and predicate
    std::vector<Change> changes_;
    std::vector<Change> undone_;
    std::uint64_t version_ = 1;
};

}  // namespace etlc::label
