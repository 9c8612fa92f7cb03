#include "plan/targets/stored.hpp"

#include <algorithm>
#include <bit>

#include "etlmon/checksum.hpp"
#include "etlmon/distance/layout.hpp"
#include "etlmon/distance/search.hpp"
#include "plan/targets/kernels.hpp"

namespace etlc::plan {

namespace {

constexpr std::size_t kPieceBytes = 1U << 20U;

/// Writes rows `first` to `end` - 1 of the set.
void fill(const StoredNumbers& numbers, const StoredSet& set, std::size_t first, std::size_t end,
          std::vector<float>& rows, std::vector<float>& piece) {
    const std::size_t stride = set.row_bytes / sizeof(float);
    const std::size_t width = numbers.dimension;
    rows.assign(numbers.values.begin() + static_cast<std::ptrdiff_t>(first * width),
                numbers.values.begin() + static_cast<std::ptrdiff_t>(end * width));
    if (!set.as_given)
        etlmon::prepare(etlmon::MetricId::cosine, rows.data(),
                        static_cast<std::uint32_t>(end - first), numbers.dimension);
    piece.assign((end - first) * stride, 0.0F);
    for (std::size_t row = 0; row < end - first; ++row)
        std::copy_n(rows.data() + row * width, width, piece.data() + row * stride);
    if constexpr (std::endian::native == std::endian::big) {
        auto* bytes = reinterpret_cast<std::uint8_t*>(piece.data());
        for (std::size_t i = 0; i < piece.size(); ++i)
            std::reverse(bytes + 4 * i, bytes + 4 * i + 4);
    }
}

}  // namespace

std::vector<StoredSet> stored_sets(const Plan& plan, std::uint64_t inline_bytes) {
    std::vector<StoredSet> sets;
    std::uint64_t offset = 0;
    for (Index d : plan.distances) {
        const check::Distance& distance = plan.model->distances[d];
        if (distance.is_between_points()) continue;
        const check::Target& target = plan.model->targets[distance.target];
        const bool as_given = rows_as_given(distance);
        const bool known = std::any_of(sets.begin(), sets.end(), [&](const StoredSet& set) {
            return set.target == distance.target && set.as_given == as_given;
        });
        if (known || target.values.size() * sizeof(float) <= inline_bytes) continue;
        sets.push_back({distance.target, as_given, offset,
                        etlmon::detail::padded(target.dimension) * sizeof(float)});
        offset += target.rows * sets.back().row_bytes;
    }
    for (Index p : projected_points(*plan.model, plan.distances)) {
        const Index projection = plan.model->points[p].projection;
        const bool known = std::any_of(sets.begin(), sets.end(), [&](const StoredSet& set) {
            return set.projection == projection;
        });
        const auto size =
            static_cast<std::uint32_t>(plan.model->projections[projection].matrix.size());
        if (known || size * sizeof(float) <= inline_bytes) continue;
        sets.push_back(
            {check::kNone, true, offset, etlmon::detail::padded(size) * sizeof(float), projection});
        offset += sets.back().row_bytes;
    }
    return sets;
}

StoredNumbers numbers_of(const check::Model& model, const StoredSet& set) {
    if (set.projection != check::kNone) {
        const check::Projection& map = model.projections[set.projection];
        return {map.name,   map.origin, map.span,
                map.matrix, 1,          static_cast<std::uint32_t>(map.matrix.size())};
    }
    const check::Target& target = model.targets[set.target];
    return {target.name, target.origin, target.span, target.values, target.rows, target.dimension};
}

const StoredSet* stored_projection(const Plan& plan, Index projection) {
    const auto found = std::find_if(plan.stored.begin(), plan.stored.end(),
                                    [&](const auto& set) { return set.projection == projection; });
    return found == plan.stored.end() ? nullptr : &*found;
}

const StoredSet* stored_set(const Plan& plan, Index d) {
    const check::Distance& distance = plan.model->distances[d];
    if (distance.is_between_points()) return nullptr;
    const auto found =
        std::find_if(plan.stored.begin(), plan.stored.end(), [&](const StoredSet& set) {
            return set.target == distance.target && set.as_given == rows_as_given(distance);
        });
    return found == plan.stored.end() ? nullptr : &*found;
}

bool searches(const Plan& plan, Index d) {
    const check::Distance& distance = plan.model->distances[d];
    if (distance.aggregation != check::Aggregation::min || stored_set(plan, d) == nullptr)
        return false;
    const std::uint32_t rows = plan.model->targets[distance.target].rows;
    switch (metric_id(distance)) {
#define DISTANCE(id, Type, prepared, zero_is_unknown) \
    case etlmon::MetricId::id:                        \
        return etlmon::searches<etlmon::Type>(rows);
#include "etlmon/distance/distances.def"
#undef DISTANCE
    }
    return false;
}

std::uint64_t search_bytes(const check::Target& target) {
    return sizeof(float) *
           (target.dimension + std::uint64_t{etlmon::detail::blocks_of(target.rows)} + 2);
}

std::uint64_t stored_bytes(const Plan& plan) {
    if (plan.stored.empty()) return 0;
    const StoredSet& last = plan.stored.back();
    return last.offset + numbers_of(*plan.model, last).rows * last.row_bytes;
}

bool store(const Plan& plan,
           const std::function<bool(const std::uint8_t* bytes, std::size_t size)>& take) {
    std::vector<float> rows;
    std::vector<float> piece;
    for (const StoredSet& set : plan.stored) {
        const StoredNumbers numbers = numbers_of(*plan.model, set);
        const std::size_t at_once = std::max<std::size_t>(1, kPieceBytes / set.row_bytes);
        for (std::size_t row = 0; row < numbers.rows; row += at_once) {
            fill(numbers, set, row, std::min<std::size_t>(row + at_once, numbers.rows), rows,
                 piece);
            if (!take(reinterpret_cast<const std::uint8_t*>(piece.data()),
                      piece.size() * sizeof(float)))
                return false;
        }
    }
    return true;
}

std::uint64_t stored_hash(const Plan& plan) {
    etlmon::Checksum checksum;
    store(plan, [&](const std::uint8_t* bytes, std::size_t size) {
        checksum.add(bytes, size);
        return true;
    });
    return checksum.value();
}

}  // namespace etlc::plan
