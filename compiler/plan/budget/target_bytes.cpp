#include <set>
#include <tuple>

#include "etlmon/distance/layout.hpp"
#include "plan/budget/budget.hpp"
#include "plan/targets/kernels.hpp"
#include "plan/targets/narrow_targets.hpp"
#include "plan/targets/point_checks.hpp"
#include "plan/targets/stored.hpp"

namespace etlc::plan {

namespace {

std::uint64_t element_bytes(Storage storage) {
    switch (storage) {
        case Storage::f32: return sizeof(float);
        case Storage::f16: return sizeof(std::uint16_t);
        case Storage::i8: break;
    }
    return sizeof(std::int8_t);
}

/// Rounds up to cache lines, because columns are an aligned struct.
std::uint64_t whole_lines(std::uint64_t bytes) {
    constexpr std::uint64_t kLine = 64;
    return (bytes + kLine - 1) / kLine * kLine;
}

/// Sums the arrays of an object, each once.
class Arrays {
public:
    Arrays(const Plan& plan, bool vectors) : plan_(plan), vectors_(vectors) {}

    void add(Index d) {
        const check::Distance& distance = plan_.model->distances[d];
        bytes_ += distance.weights.size() * sizeof(float);
        if (distance.is_between_points()) return;
        const NarrowSet* narrow = narrow_set(plan_, d);
        if (narrow != nullptr) add_rows(distance, narrow->storage);
        if (const StoredSet* stored = stored_set(plan_, d)) {
            if (stored_.insert(stored).second)
                bytes_ += plan_.model->targets[stored->target].rows * stored->row_bytes;
        } else if (narrow == nullptr || !narrow->lossless) {
            add_rows(distance, Storage::f32);
        }
    }

    void add_projection(Index index) {
        if (!projections_.insert(index).second) return;
        const check::Projection& map = plan_.model->projections[index];
        const StoredSet* const stored = stored_projection(plan_, index);
        bytes_ += stored != nullptr ? stored->row_bytes : map.matrix.size() * sizeof(float);
        bytes_ += map.offset.size() * sizeof(float);
    }

    std::uint64_t bytes() const { return bytes_; }

private:
    using Rows = std::pair<Index, bool>;  ///< a target, as given or normalised
    static Rows rows_of(const check::Distance& distance) {
        return {distance.target, rows_as_given(distance)};
    }

    void add_rows(const check::Distance& distance, Storage storage) {
        const check::Target& target = plan_.model->targets[distance.target];
        const std::uint32_t rows = target.rows;
        const std::uint32_t dimension = target.dimension;
        // Retargetable classes store plain rows for all machines.
        const bool columns = !plan_.model->retargetable &&
                             metric_id(distance) != etlmon::MetricId::mahalanobis &&
                             etlmon::detail::in_columns(rows, dimension, vectors_);
        if (!arrays_.emplace(rows_of(distance), storage, columns).second) return;
        if (columns)
            bytes_ += whole_lines(element_bytes(storage) *
                                  etlmon::detail::column_elements(rows, dimension, vectors_));
        else
            bytes_ += element_bytes(storage) * rows * dimension;
    }

    const Plan& plan_;
    bool vectors_;
    std::set<std::tuple<Rows, Storage, bool>> arrays_;
    std::set<const StoredSet*> stored_;
    std::set<Index> projections_;
    std::uint64_t bytes_ = 0;
};

}  // namespace

std::uint64_t target_bytes(const Plan& plan, const std::set<Index>& distances, Vectors vectors) {
    Arrays arrays(plan, vectors == Vectors::with);
    for (Index d : distances) arrays.add(d);
    for (Index p : projected_points(*plan.model, {distances.begin(), distances.end()}))
        arrays.add_projection(plan.model->points[p].projection);
    return arrays.bytes();
}

}  // namespace etlc::plan
