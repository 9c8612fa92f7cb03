#include "episodes/leaks.hpp"

#include <algorithm>
#include <cmath>

namespace etlc::episodes {

namespace {

using check::Distance;
using check::Input;
using check::InputType;

/// Covers what is rounded here, and what normalising an embedding in float32 rounds.
constexpr double kFourRoundings = 4 * 0x1p-24;

/// How far a number moves when it is rounded to the input's type. Targets are float32, and so are
/// the samples of all inputs but these two.
double rounding(const Input& input, double x) {
    constexpr double kABitMore = 1 + 0x1p-8;
    switch (input.type) {
        case InputType::f16: return (std::abs(x) * 0x1p-11 + 0x1p-25) * kABitMore;
        case InputType::i8: return static_cast<double>(input.scale) / 2 * kABitMore;
        default: return 0;
    }
}

double length(const float* v, std::size_t n) {
    double square = 0;
    for (std::size_t i = 0; i < n; ++i)
        square += static_cast<double>(v[i]) * static_cast<double>(v[i]);
    return std::sqrt(square);
}

/// The rows as they were before they were projected.
const check::Target& declared_target(const check::Model& model, const Distance& distance) {
    const check::Target& target = model.targets[distance.target];
    return target.source == check::kNone ? target : model.targets[target.source];
}

/// What the point is made of, however it is projected.
const std::vector<Index>& inputs_of(const check::Model& model, const Distance& distance) {
    return model.points[distance.point].inputs;
}

bool is_embedding(const check::Model& model, const Distance& distance) {
    return model.inputs[inputs_of(model, distance)[0]].is_embedding();
}

/// A vector of scalars may well come to lie where somebody has written a target down: a robot stops
/// at the origin. Rows of a file are looked for all the same, for they may have been recorded.
bool may_be_recorded(const check::Model& model, const Distance& distance) {
    const check::Target& target = declared_target(model, distance);
    if (target.space != check::kNone) return false;  // rows that no sample is compared with
    return is_embedding(model, distance) || !target.path.empty();
}

/// The numbers of a vector of scalars; empty where one is missing.
std::vector<float> gathered(const check::Model& model, const Distance& distance,
                            const std::vector<plan::Sample>& samples) {
    std::vector<float> point;
    for (const Index input : inputs_of(model, distance)) {
        const plan::Sample& sample = samples[input];
        if (!sample.present || !model.inputs[input].range.contains(sample.values[0])) return {};
        point.push_back(sample.values[0]);
    }
    return point;
}

/// Two numbers of a row and a sample are told apart where they differ by more than the sample was
/// rounded.
struct Rounded {
    const Input& input;
    double relative = 0;  ///< of the row's number, which by direction has the sample's length

    bool same(double x, double g) const {
        return std::abs(x - g) <= relative * std::abs(g) + rounding(input, x);
    }
};

/// By direction: how far the length of z is from that of what was rounded to it, relative to it.
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
            if (may_be_recorded(model, model.distances[distance])) watch(predicate, distance);
        });
}

void Leaks::watch(Index predicate, Index index) {
    const Distance& distance = model_.distances[index];
    const check::Target& target = declared_target(model_, distance);
    Watched watched{predicate, index, false, {}, {}};
    watched.by_direction = target.dimension > 1 && check::is_of_directions(distance.metric) &&
                           !model_.points[distance.point].is_projected();
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

std::optional<Leak> Leaks::find(const std::vector<plan::Sample>& samples,
                                std::uint64_t frame) const {
    for (const Watched& watched : watched_) {
        const auto row = row_of(watched, samples);
        if (row) return Leak{watched.predicate, watched.distance, *row, frame};
    }
    return std::nullopt;
}

/// Row by row, of which the first element tells nearly all apart. z is the row g or, by direction,
/// |z| / |g| times g.
std::optional<std::uint32_t> Leaks::row_of(const Watched& watched,
                                           const std::vector<plan::Sample>& samples) const {
    const Distance& distance = model_.distances[watched.distance];
    const check::Target& target = declared_target(model_, distance);
    const Index first = inputs_of(model_, distance)[0];
    const plan::Sample& sample = samples[first];
    const bool embedding = is_embedding(model_, distance);
    const auto vector = embedding ? std::vector<float>{} : gathered(model_, distance, samples);
    const std::vector<float>& z = embedding ? sample.values : vector;
    if (!sample.present || z.empty()) return std::nullopt;
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
