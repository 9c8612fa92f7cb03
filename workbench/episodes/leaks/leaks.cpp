#include "episodes/leaks/leaks.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "check/points/points.hpp"
#include "plan/targets/kernels.hpp"
#include "plan/targets/narrow_targets.hpp"

namespace etlc::episodes {

// ---- rows that a frame equals up to rounding ----------------------------------------------------

namespace {

using check::InputType;
using check::Projection;

constexpr double kUnit = 0x1p-24;  ///< relative error of one rounding to float32
/// A sum of D rounded terms is off by random roundings of its partial sums, whose norm grows as
/// sqrt(D); it stays within this factor of that, in any order of additions.
constexpr double kDeviations = 4;
/// The sum of roundings to a grid stays within this factor times the norm of as many half steps of
/// the grid: 4 standard deviations.
constexpr double kOfUniform = 2.3;
/// `wide` is this many bounds about a row, or this share of the point's largest element if that is
/// more, because recordings are not finer.
constexpr double kWide = 8;
constexpr double kWideOfSize = 0x1p-9;

double half_rounding(double x) {
    return std::abs(x) * 0x1p-11 + 0x1p-25;
}

bool is_half(const float* v, std::size_t n) {
    return std::all_of(v, v + n, [](float x) {
        const auto wide = static_cast<double>(x);
        return plan::to_f16(wide) == wide;
    });
}

double largest(const std::vector<double>& all) {
    return all.empty() ? 0 : *std::max_element(all.begin(), all.end());
}

double largest_size(const std::vector<float>& all) {
    double size = 0;
    for (const float x : all) size = std::max(size, std::abs(static_cast<double>(x)));
    return size;
}

}  // namespace

double length(const float* v, std::size_t n) {
    double square = 0;
    for (std::size_t i = 0; i < n; ++i)
        square += static_cast<double>(v[i]) * static_cast<double>(v[i]);
    return std::sqrt(square);
}

RoundedRows::RoundedRows(const check::Model& model, Index distance, Index point, Index target,
                         std::uint32_t offset)
    : model_(model),
      point_(point),
      target_(target),
      offset_(offset),
      norms_(model.projections.size()) {
    const check::Distance& of = model.distances[distance];
    const check::Target& rows = model.targets[target];
    if (check::as_of_now(model, of.point) == point || model.points[of.point].is_joined()) {
        by_direction_ = dimension() > 1 && check::is_of_directions(of.metric);
        if (of.weights_diagonal)
            weights_.assign(of.weights.begin() + offset, of.weights.begin() + offset + dimension());
    }
    for (std::uint32_t row = 0; row < rows.rows; ++row) {
        is_half_.push_back(is_half(row_at(row), dimension()));
        if (by_direction_) per_length_.push_back(1 / length(row_at(row), dimension()));
    }
    for (Index at = point; model.points[at].is_projected(); at = model.points[at].inner) {
        const Projection& map = model.projections[model.points[at].projection];
        std::vector<RowNorms>& norms = norms_[model.points[at].projection];
        norms.resize(map.rows);
        for (std::size_t i = 0; i < map.rows; ++i) {
            double product = 0;
            double square = 0;
            for (std::size_t j = 0; j < map.dimension; ++j) {
                const auto a = static_cast<double>(map.matrix[i * map.dimension + j]);
                const double am = map.offset.empty() ? 0 : a * static_cast<double>(map.offset[j]);
                norms[i].sum += std::abs(a);
                norms[i].length += a * a;
                product += am;
                square += am * am;
            }
            norms[i].length = std::sqrt(norms[i].length);
            norms[i].offset = std::sqrt(square) + 2 * std::abs(product);
        }
    }
    if (rows.source != check::kNone) add_moves(rows);
}

const float* RoundedRows::row_at(std::size_t row) const {
    const check::Target& rows = model_.targets[target_];
    return rows.values.data() + row * rows.dimension + offset_;
}

/// Computes how far storing and then projecting moved each row: the maximum over its elements.
void RoundedRows::add_moves(const check::Target& rows) {
    const check::Target& declared = model_.targets[rows.source];
    Index from = declared.space;
    if (from == check::kNone)
        for (from = point_; model_.points[from].is_projected();) from = model_.points[from].inner;
    for (std::uint32_t row = 0; row < rows.rows; ++row) {
        const float* g = declared.values.data() + std::size_t{row} * declared.dimension;
        moved_.push_back(0);
        if (!is_half(g, declared.dimension)) continue;
        Rounded stored{{g, g + declared.dimension}, {}};
        for (const float x : stored.elements)
            stored.error.push_back(half_rounding(static_cast<double>(x)));
        moved_.back() = largest(projected(point_, from, stored).error);
    }
}

bool RoundedRows::may_be_near(const std::vector<float>& sample) const {
    constexpr std::size_t kProbes = 4;
    const check::Input& input = model_.inputs[model_.points[point_].inputs[0]];
    const std::size_t n = sample.size();
    const double per_length = by_direction_ ? 1 / length(sample.data(), n) : 1;
    if (!std::isfinite(per_length)) return true;
    std::uint32_t largest = 0;  // as bits, which sort as magnitudes do
    for (const float x : sample)
        largest = std::max(largest, std::bit_cast<std::uint32_t>(x) & 0x7fff'ffffU);
    const auto size = static_cast<double>(std::bit_cast<float>(largest));
    const double least = kWideOfSize * size * per_length;
    const double grain = input.type == InputType::i8 ? static_cast<double>(input.scale) / 2 : 0;
    for (std::size_t row = 0; row < is_half_.size(); ++row) {
        const float* g = row_at(row);
        const double per_row = by_direction_ ? per_length_[row] : 1;
        bool near = true;
        for (std::size_t i = 0; near && i < std::min(n, kProbes); ++i) {
            const auto x = static_cast<double>(sample[i]);
            const auto y = static_cast<double>(g[i]);
            // At least what add_row() allows.
            const double bound = (half_rounding(x) + grain) * per_length +
                                 half_rounding(y) * per_row + kDeviations * kUnit;
            near = std::abs(x * per_length - y * per_row) <= std::max(kWide * bound, least);
        }
        if (near) return true;
    }
    return false;
}

/// Returns the recorded point, and how far storing may have moved it.
RoundedRows::Rounded RoundedRows::taken(Index index,
                                        const std::vector<execute::Sample>& samples) const {
    const check::Point& point = model_.points[index];
    const check::Input& input = model_.inputs[point.inputs[0]];
    Rounded result;
    for (const Index of : point.inputs) {
        const execute::Sample& sample = samples[of];
        const bool there = sample.present && (input.is_embedding() ||
                                              model_.inputs[of].range.contains(sample.values[0]));
        if (!there || !execute::all_finite(sample.values.data(), sample.values.size())) return {};
        result.elements.insert(result.elements.end(), sample.values.begin(), sample.values.end());
    }
    const bool half =
        input.type == InputType::f16 ||
        (input.type == InputType::f32 && is_half(result.elements.data(), result.elements.size()));
    for (const float x : result.elements)
        result.error.push_back(input.type == InputType::i8 ? static_cast<double>(input.scale) / 2
                               : half                      ? half_rounding(static_cast<double>(x))
                                                           : 0);
    return result;
}

RoundedRows::Rounded RoundedRows::projected(Index index, Index from, const Rounded& at) const {
    if (index == from) return at;
    const check::Point& point = model_.points[index];
    const Rounded inner = projected(point.inner, from, at);
    if (inner.elements.empty()) return {};
    const Projection& map = model_.projections[point.projection];
    const std::vector<RowNorms>& norms = norms_[point.projection];
    Rounded result;
    if (!plan::project(map, inner.elements, result.elements)) return {};
    const std::vector<double> moved = carried(inner, map, norms, point.inner);
    const double size = largest_size(inner.elements);
    const double of_sums = kDeviations * kUnit * std::sqrt(static_cast<double>(map.dimension));
    for (std::size_t i = 0; i < map.rows; ++i) {
        const double y = std::abs(static_cast<double>(result.elements[i]));
        result.error.push_back(moved[i] + of_sums * (norms[i].length * size + y + norms[i].offset));
    }
    return result;
}

/// Carries the errors of a point through the map. Roundings of samples are independent, those of
/// sums are not.
std::vector<double> RoundedRows::carried(const Rounded& inner, const Projection& map,
                                         const std::vector<RowNorms>& norms, Index from) const {
    std::vector<double> moved(map.rows);
    const double most = largest(inner.error);
    if (most == 0) return moved;
    const bool of_sums = model_.points[from].is_projected();
    for (std::size_t i = 0; i < map.rows; ++i) {
        moved[i] = norms[i].sum * most;
        if (of_sums) continue;
        double square = 0;
        for (std::size_t j = 0; j < map.dimension; ++j) {
            const double one =
                static_cast<double>(map.matrix[i * map.dimension + j]) * inner.error[j];
            square += one * one;
        }
        moved[i] = std::min(moved[i], kOfUniform * std::sqrt(square));
    }
    return moved;
}

/// Widens the errors of elements of small weight to what the others' roundings outweigh.
void RoundedRows::weigh(Rounded& at) const {
    double outweighed = 0;
    for (std::size_t i = 0; i < weights_.size(); ++i) {
        const double x = std::abs(static_cast<double>(at.elements[i]));
        outweighed = std::max(outweighed, std::sqrt(static_cast<double>(weights_[i])) *
                                              (at.error[i] + 2 * kUnit * x));
    }
    for (std::size_t i = 0; i < weights_.size(); ++i)
        at.error[i] += outweighed / std::sqrt(static_cast<double>(weights_[i]));
}

RoundedRows::Found RoundedRows::find(const std::vector<execute::Sample>& samples) const {
    const check::Point& point = model_.points[point_];
    const bool is_plain = !point.is_projected() && point.inputs.size() == 1 && weights_.empty();
    if (is_plain && !may_be_near(samples[point.inputs[0]].values)) return {};
    Index from = point_;
    while (model_.points[from].is_projected()) from = model_.points[from].inner;
    Rounded at = projected(point_, from, taken(from, samples));
    Found found;
    if (at.elements.empty()) return found;
    if (!weights_.empty()) weigh(at);
    if (by_direction_) {
        const double size = length(at.elements.data(), at.elements.size());
        if (!(size > 0)) return found;
        for (std::size_t i = 0; i < at.elements.size(); ++i) {
            at.elements[i] = static_cast<float>(static_cast<double>(at.elements[i]) / size);
            at.error[i] = at.error[i] / size + kDeviations * kUnit;
        }
    }
    const auto of_largest =
        std::max_element(at.elements.begin(), at.elements.end(),
                         [](float a, float b) { return std::abs(a) < std::abs(b); });
    const double size = std::abs(static_cast<double>(*of_largest));
    const auto place = static_cast<std::size_t>(of_largest - at.elements.begin());
    for (std::uint32_t row = 0; row < is_half_.size(); ++row) add_row(at, size, place, row, found);
    return found;
}

void RoundedRows::add_row(const Rounded& at, double size, std::size_t largest, std::uint32_t row,
                          Found& found) const {
    const std::size_t n = at.elements.size();
    const float* g = row_at(row);
    const double per_length = by_direction_ ? per_length_[row] : 1;
    bool within = true;
    bool close = true;
    double evenly_close = 1;
    double evenly_wide = 1;
    for (std::size_t i = 0; i < n; ++i) {
        const auto y = static_cast<double>(at.elements[i]);
        const double x = static_cast<double>(g[i]) * per_length;
        const double stored = is_half_[row] ? half_rounding(static_cast<double>(g[i])) * per_length
                                            : 2 * kUnit * std::abs(x);
        const double moved = moved_.empty() ? 0 : moved_[row] * per_length;
        const double bound = at.error[i] + stored + moved;
        const double wide = std::max(kWide * bound, kWideOfSize * size);
        const double apart = std::abs(y - x);
        if (!(apart <= wide)) return;
        within = within && apart <= bound;
        close = close && apart <= 2 * bound;
        // Elements that are zero, as where nothing is seen, or lost in their bounds tell nothing;
        // of a direction one follows from the others.
        const bool tells = (y != 0 || x != 0) && kWide * bound < size;
        if (!tells || (by_direction_ && i == largest)) continue;
        evenly_close /= 2;
        evenly_wide *= bound / wide;
    }
    const auto add = [](Around& around, double chance) {
        around.frames = 1;
        around.chance = std::min(1.0, around.chance + chance);
    };
    add(found.wide, evenly_wide);
    if (close) add(found.close, evenly_close);
    if (within && !found.row) found.row = row;
}

// ---- frames that equal a row --------------------------------------------------------------------

namespace {

using check::Distance;
using check::Input;

/// Covers the rounding here, and that of normalising an embedding in float32.
constexpr double kFourRoundings = 4 * 0x1p-24;

/// Returns how far rounding to the input's type moves a number. Targets are float32, and so are the
/// samples of all inputs but these two.
double rounding(const Input& input, double x) {
    constexpr double kABitMore = 1 + 0x1p-8;
    switch (input.type) {
        case InputType::f16: return half_rounding(x) * kABitMore;
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

/// Returns false for points put together, of which frames are parts, and for sums.
bool has_frames(const check::Model& model, const Distance& distance) {
    return point_of(model, distance) != check::kNone;
}

/// Returns the points put together that a distance measures, or their sum, perhaps behind
/// projections.
const check::Point& parts_of(const check::Model& model, const Distance& distance) {
    Index at = distance.point;
    while (model.points[at].parts.empty()) at = model.points[at].inner;
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
    const check::Point& joined = parts_of(model_, distance);
    if (joined.is_sum() || declared_target(model_, distance).space != check::kNone) return;
    std::uint32_t offset = 0;
    for (const Index part : joined.parts) {
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
    if (!sample.present || z.empty() || !execute::all_finite(z.data(), z.size()))
        return std::nullopt;
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
