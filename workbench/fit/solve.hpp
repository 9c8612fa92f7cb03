// One fitted thing from what was collected.
// Takes: the model with what stands before it filled, and the folds to fit on. Gives: the numbers,
// or why there are none. Keeps true: all is computed in double and rounded once, to float32; a map
// fitted in between is the float32 one that the monitor computes with.
#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "check/points/project.hpp"
#include "fit/algebra/clusters.hpp"
#include "fit/algebra/linear.hpp"
#include "fit/collect.hpp"

namespace etlc::fit {

/// Results that several threads ask for, each made once.
template <class Key, class Value>
class Memo {
public:
    /// `make()` gives the value of the key. Those who ask meanwhile wait.
    template <class Make>
    const Value& get(const Key& key, const Make& make) {
        Entry& entry = entry_of(key);
        std::call_once(entry.once, [&] { entry.value = make(); });
        return entry.value;
    }

private:
    struct Entry {
        std::once_flag once;
        Value value;
    };

    Entry& entry_of(const Key& key) {
        const std::lock_guard lock(finding_);
        return entries_[key];
    }

    std::mutex finding_;
    std::map<Key, Entry> entries_;
};

struct Solution {
    check::Filling filling;
    Counts counts;                       ///< of the frames that it was fitted on
    std::optional<double> shrinkage;     ///< discriminant
    std::optional<double> explained;     ///< components: part of the variance
    std::uint64_t constant = 0;          ///< elements of the point that never change
    std::uint64_t taken = 0;             ///< kmeans, medoids: frames to choose from
    std::vector<const Source*> medoids;  ///< per row
};

/// Why there is no solution.
struct Refusal {
    diag::Code code = diag::Code::too_few_frames;
    std::string message;
};

/// The needs of all that the model has fitted, each once; `of`: per fitted thing, which one is its.
struct Needs {
    std::vector<Need> all;
    std::vector<std::size_t> of;

    /// Where it stands in `all`; there from now on.
    std::size_t add(const Need& need);
};
Needs needs_of(const check::Model& model);

/// The frames that were taken for a need, in order, of all folds.
struct TakenPoints {
    TakenPoints() = default;
    TakenPoints(const Collection& collection, std::size_t need);

    /// As columns.
    Matrix frames(const Members& members) const;

    std::vector<const Source*> sources;
    Points points;
};

/// Solves what a model has fitted. Any number of threads may use it at once: what several fits need
/// of the same frames is computed once. All that it is given outlives it.
class Solver {
public:
    Solver(const Collection& collection, const Needs& needs)
        : collection_(collection), needs_(needs) {}

    /// `left_out`: a fold that is not fitted on.
    std::variant<Solution, Refusal> solve(const check::Model& model, Index fitted,
                                          std::optional<std::size_t> left_out);

    const Collection& collection() const { return collection_; }
    const Needs& needs() const { return needs_; }

private:
    friend class Solving;

    /// Of a need, with up to two folds left out.
    struct Part {
        std::size_t need = 0;
        std::optional<std::size_t> first, second;

        auto operator<=>(const Part&) const = default;
    };

    /// Of all other folds together.
    Moments moments(const Part& part) const;
    /// Trained on all folds of the part but this one, which it is tested on.
    Trial trial(const Part& part, std::size_t test);
    const Variances& variances(const Part& part, Eigen::Index r);
    const TakenPoints& points(std::size_t need);

    const Collection& collection_;
    const Needs& needs_;
    Memo<Part, std::vector<Trial>> trials_;  ///< per fold left out: two parts lack the same two
    Memo<std::pair<Part, Eigen::Index>, Variances> variances_;
    Memo<std::size_t, TakenPoints> points_;  ///< by need
};

}  // namespace etlc::fit
