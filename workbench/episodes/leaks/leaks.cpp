#include "episodes/leaks/leaks.hpp"

#include <algorithm>
#include <cmath>

#include "check/points/points.hpp"

namespace etlc::episodes {

namespace {

using check::Distance;
using check::Input;
using check::InputType;

/// Covers the rounding here, and that of normalising an embedding in float32.
constexpr double kFourRoundings = 4 * 0x1p-24;

/// Returns how far rounding to the input's type moves a number. Targets are float32, and so are the
/// samples of all inputs but these two.
double rounding(const Input& input, double x) {
    constexpr double kABitMore = 1 + 0x1p-8;
    switch (input.type) {
        case InputType::f16: return (std::abs(x) * 0x1p-11 + 0x1p-25) * kABitMore;
        case InputType::i8: return static_cast<double>(input.scale) / 2 * kABitMore;
        default: return 0;
    }
}

/// Returns the target as declared, before it was projected.
Index declared(const check::Model& model, const Distance& distance) {
    const Index source = model.targets[distance.target].source;
    return source == check::kNone ? distance.target : source;
}

const check::Target& declared_target(const check::Model& model, const Distance& distance) {
    return model.targets[declared(model, distance)];
}

/// Returns the point that a distance is measured from, without its delay.
Index point_of(const check::Model& model, const Distance& distance) {
    return check::as_of_now(model, distance.point);
}

/// Returns the point in whose space the rows were declared.
Index declared_space(const check::Model& model, const Distance& distance) {
    const Index space = declared_target(model, distance).space;
    if (space != check::kNone) return space;
    Index at = point_of(model, distance);
    while (model.points[at].is_projected()) at = model.points[at].inner;
    return at;
}

/// Returns the inputs of the point, before any projection.
const std::vector<Index>& inputs_of(const check::Model& model, const Distance& distance) {
    return model.points[distance.point].inputs;
}

bool is_embedding(const check::Model& model, const Distance& distance) {
    return model.inputs[inputs_of(model, distance)[0]].is_embedding();
}

/// Returns false where a projection on the way is not fitted yet.
bool is_there(const check::Model& model, Index point) {
    Index at = point;
    while (model.points[at].is_projected() &&
           !model.projections[model.points[at].projection].matrix.empty())
        at = model.points[at].inner;
    return !model.points[at].is_projected();
}

/// Returns whether rows may stem from a recording. Scalars can reach a hand-written target by
/// themselves: a robot stops at the origin. Rows of a file may have been recorded, so they are
/// checked.
bool may_be_recorded(const check::Model& model, const Distance& distance) {
    return is_embedding(model, distance) || !declared_target(model, distance).path.empty();
}

/// Returns the numbers of a vector of scalars; empty where one is missing.
std::vector<float> gathered(const check::Model& model, const Distance& distance,
                            const std::vector<execute::Sample>& samples) {
    std::vector<float> point;
    for (const Index input : inputs_of(model, distance)) {
        const execute::Sample& sample = samples[input];
        if (!sample.present || !model.inputs[input].range.contains(sample.values[0])) return {};
        point.push_back(sample.values[0]);
    }
    return point;
}

/// Returns false for points put together: frames are parts of rows, not rows.
bool has_frames(const check::Model& model, const Distance& distance) {
    return point_of(model, distance) != check::kNone;
}

/// Returns the points put together that a distance measures, perhaps behind projections.
const check::Point& joined_of(const check::Model& model, const Distance& distance) {
    Index at = distance.point;
    while (!model.points[at].is_joined()) at = model.points[at].inner;
    return model.points[at];
}

/// Compares numbers of a row and a sample: they differ where rounding of the sample cannot explain
/// it.
struct Rounded {
    const Input& input;
    double relative = 0;  ///< relative to the row's number; by direction, at the sample's length

    bool same(double x, double g) const {
        return std::abs(x - g) <= relative * std::abs(g) + rounding(input, x);
    }
};

/// Returns the relative change of the length of z by rounding, for comparison by direction.
double rounding_of_length(const Input& input, const std::vector<float>& z, double size) {
    double square = 0;
    for (const float x : z) {
        const double by = rounding(input, static_cast<double>(x));
        square += by * by;
    }
    return std::sqrt(square) / size + kFourRoundings;
}

}  // namespace

Leaks::Leaks(const check::Model& model, const std::vector<Index>& predicates) : model_(model) {
    for (const Index predicate : predicates)
        check::for_each_distance(model.predicates[predicate].expression, [&](Index distance) {
            if (model.distances[distance].is_between_points()) return;
            if (!has_frames(model, model.distances[distance])) {
                watch_parts(predicate, distance);
                return;
            }
            if (!may_be_recorded(model, model.distances[distance])) return;
            if (declared_target(model, model.distances[distance]).space == check::kNone)
                watch(predicate, distance);
            watch_near(predicate, distance);
        });
}

void Leaks::watch(Index predicate, Index index) {
    const Distance& distance = model_.distances[index];
    const check::Target& target = declared_target(model_, distance);
    Watched watched{predicate, index, false, {}, {}};
    watched.by_direction = target.dimension > 1 && check::is_of_directions(distance.metric) &&
                           !model_.points[point_of(model_, distance)].is_projected();
    const bool known = std::any_of(watched_.begin(), watched_.end(), [&](const Watched& other) {
        const Distance& of = model_.distances[other.distance];
        return inputs_of(model_, of) == inputs_of(model_, distance) &&
               &declared_target(model_, of) == &target &&
               other.by_direction == watched.by_direction;
    });
    if (known) return;
    for (std::uint32_t row = 0; row < target.rows; ++row) {
        const float* g = target.values.data() + static_cast<std::size_t>(row) * target.dimension;
        const double size = watched.by_direction ? length(g, target.dimension) : 1;
        if (watched.by_direction) watched.lengths.push_back(size);
        watched.firsts.push_back(static_cast<double>(g[0]) / size);
    }
    watched_.push_back(std::move(watched));
}

/// Watches where the rows were declared, and where the distance measures: there frames also count
/// that only the projection makes alike.
void Leaks::watch_near(Index predicate, Index index) {
    const Distance& distance = model_.distances[index];
    const Index space = declared_space(model_, distance);
    add_near({predicate, index}, space, declared(model_, distance));
    const Index point = point_of(model_, distance);
    if (space != point) add_near({predicate, index}, point, distance.target);
}

/// Watches the parts of points put together that are frames, perhaps projected.
void Leaks::watch_parts(Index predicate, Index index) {
    const Distance& distance = model_.distances[index];
    if (declared_target(model_, distance).space != check::kNone) return;
    std::uint32_t offset = 0;
    for (const Index part : joined_of(model_, distance).parts) {
        const Index point = check::as_of_now(model_, part);
        const bool embedding = model_.inputs[model_.points[part].inputs[0]].is_embedding();
        if (embedding && point != check::kNone)
            add_near({predicate, index}, point, declared(model_, distance), offset);
        offset += model_.points[part].dimension;
    }
}

void Leaks::add_near(Measuring by, Index point, Index target, std::uint32_t offset) {
    if (model_.targets[target].values.empty() || !is_there(model_, point)) return;
    RoundedRows rows(model_, by.distance, point, target, offset);
    const bool known =
        std::any_of(watched_near_.begin(), watched_near_.end(),
                    [&](const WatchedNear& other) { return other.rows.same_as(rows); });
    if (!known) watched_near_.push_back({by.predicate, by.distance, std::move(rows)});
}

void Leaks::find_near(const std::vector<execute::Sample>& samples, std::uint64_t frame,
                      std::vector<NearLeak>& near) const {
    near.resize(watched_near_.size());
    for (std::size_t i = 0; i < watched_near_.size(); ++i) {
        const WatchedNear& watched = watched_near_[i];
        const RoundedRows::Found found = watched.rows.find(samples);
        near[i].close.add(found.close);
        near[i].wide.add(found.wide);
        if (found.row && !near[i].first)
            near[i].first = Leak{watched.predicate, watched.distance, *found.row, frame};
    }
}

std::optional<Leak> Leaks::find(const std::vector<execute::Sample>& samples,
                                std::uint64_t frame) const {
    for (const Watched& watched : watched_) {
        const auto row = row_of(watched, samples);
        if (row) return Leak{watched.predicate, watched.distance, *row, frame};
    }
    return std::nullopt;
}

/// Compares row by row; the first element excludes nearly all. z is the row g or, by direction, |z|
/// / |g| times g.
std::optional<std::uint32_t> Leaks::row_of(const Watched& watched,
                                           const std::vector<execute::Sample>& samples) const {
    const Distance& distance = model_.distances[watched.distance];
    const check::Target& target = declared_target(model_, distance);
    const Index first = inputs_of(model_, distance)[0];
    const execute::Sample& sample = samples[first];
    const bool embedding = is_embedding(model_, distance);
    const auto vector = embedding ? std::vector<float>{} : gathered(model_, distance, samples);
    const std::vector<float>& z = embedding ? sample.values : vector;
    const bool finite = std::all_of(z.begin(), z.end(), [](float x) { return std::isfinite(x); });
    if (!sample.present || z.empty() || !finite) return std::nullopt;
    const double size = watched.by_direction ? length(z.data(), z.size()) : 1;
    Rounded rounded{model_.inputs[first]};
    if (watched.by_direction) rounded.relative = rounding_of_length(rounded.input, z, size);
    for (std::uint32_t row = 0; row < target.rows; ++row) {
        if (!rounded.same(static_cast<double>(z[0]), watched.firsts[row] * size)) continue;
        const float* g = target.values.data() + static_cast<std::size_t>(row) * target.dimension;
        const double factor = watched.by_direction ? size / watched.lengths[row] : 1;
        const bool all = std::equal(z.begin(), z.end(), g, [&](float x, float of_row) {
            return rounded.same(static_cast<double>(x), static_cast<double>(of_row) * factor);
        });
        if (all) return row;
    }
    return std::nullopt;
}

}  // namespace etlc::episodes
