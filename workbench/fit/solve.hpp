// Solves one fit from the collected moments and frames. Everything is computed in double and
// rounded once, to float32; a map fitted before it is the float32 one that the monitor uses.
#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "check/points/points.hpp"
#include "fit/algebra/clusters.hpp"
#include "fit/algebra/moments.hpp"
#include "fit/collect.hpp"

namespace etlc::fit {

/// A thread-safe cache, in which each value is computed once.
template <class Key, class Value>
class Memo {
public:
    /// Returns the value of the key, made by `make()` the first time. Other threads wait for it.
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
    Counts counts;                       ///< frames that it was fitted on
    std::optional<double> shrinkage;     ///< discriminant
    std::optional<double> explained;     ///< components: share of the variance
    std::uint64_t constant = 0;          ///< elements of the point that are constant
    std::uint64_t taken = 0;             ///< kmeans, medoids: frames to choose from
    std::vector<const Source*> medoids;  ///< per row
};

/// The reason why a fit has no solution.
struct Refusal {
    diag::Code code = diag::Code::too_few_frames;
    std::string message;
};

/// The needs of all fits of a model, each once; `of`: per fit, the index of its need.
struct Needs {
    std::vector<Need> all;
    std::vector<std::size_t> of;

    /// Returns the index of a need in `all`; adds it if missing.
    std::size_t add(const Need& need);
};
Needs needs_of(const check::Model& model);

/// The frames taken for a need from all folds, in order.
struct TakenPoints {
    TakenPoints() = default;
    TakenPoints(const Collection& collection, std::size_t need, unsigned jobs);

    /// Returns frames as columns.
    Matrix frames(const Members& members) const;

    std::vector<const Source*> sources;
    Points points;
};

/// Solves the fits of a model. Thread-safe: what several fits need of the same frames is computed
/// once. The arguments outlive it.
class Solver {
public:
    Solver(const Collection& collection, const Needs& needs)
        : collection_(collection), needs_(needs) {}

    /// Computes in threads what all fits of clusters share, for which they would wait.
    void prepare(const check::Model& model, unsigned jobs);

    /// `left_out`: a fold to leave out.
    std::variant<Solution, Refusal> solve(const check::Model& model, Index fitted,
                                          std::optional<std::size_t> left_out);

    const Collection& collection() const { return collection_; }
    const Needs& needs() const { return needs_; }

private:
    friend class Solving;

    /// A need, with up to two folds left out.
    struct Part {
        std::size_t need = 0;
        std::optional<std::size_t> first, second;

        auto operator<=>(const Part&) const = default;
    };

    /// Returns the moments of all other folds together.
    Moments moments(const Part& part) const;
    /// Tests on one fold of the part what all others give.
    Trial trial(const Part& part, std::size_t test);
    const Variances& variances(const Part& part, Eigen::Index r);
    const TakenPoints& points(std::size_t need, unsigned jobs = 1);

    const Collection& collection_;
    const Needs& needs_;
    Memo<Part, std::vector<Trial>>
        trials_;  ///< per fold left out; (f, g) serves both (f without g) and (g without f)
    Memo<std::pair<Part, Eigen::Index>, Variances> variances_;
    Memo<std::size_t, TakenPoints> points_;  ///< by need
};

}  // namespace etlc::fit
