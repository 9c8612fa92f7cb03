#include <algorithm>
#include <cmath>
#include <set>

#include "episodes/replay.hpp"
#include "fit/algebra/dense.hpp"
#include "plan/plan.hpp"
#include "report/tracks.hpp"

namespace etlc::report {

namespace {

constexpr std::size_t kMostFrames = 384;
constexpr std::size_t kPlaneEpisodes = 24;

using fit::Matrix;
using fit::Vector;
using Frames = std::vector<std::vector<float>>;

/// Keeps every n-th frame of a point, and doubles n when there are too many.
class EvenFrames {
public:
    explicit EvenFrames(std::size_t most) : most_(most) {}

    void add(const float* z, std::uint32_t dimension) {
        if (seen_++ % stride_ != 0) return;
        frames_.emplace_back(z, z + dimension);
        if (frames_.size() <= 2 * most_) return;
        stride_ *= 2;
        for (std::size_t i = 0; 2 * i < frames_.size(); ++i)
            if (i > 0) frames_[i] = std::move(frames_[2 * i]);
        frames_.resize((frames_.size() + 1) / 2);
    }
    /// Appends at most `most` of the frames.
    void move_to(Frames& all) {
        const std::size_t stride = frames_.size() > most_ ? 2 : 1;
        for (std::size_t i = 0; i < frames_.size(); i += stride)
            all.push_back(std::move(frames_[i]));
    }

private:
    std::size_t most_;
    std::size_t seen_ = 0;
    std::size_t stride_ = 1;
    Frames frames_;
};

bool only_angles(const check::Model& model, Index point) {
    return std::all_of(model.distances.begin(), model.distances.end(), [&](const auto& distance) {
        return distance.point != point || check::is_of_directions(distance.metric);
    });
}

double length(const float* z, std::size_t dimension) {
    double sum = 0;
    for (std::size_t i = 0; i < dimension; ++i) sum += static_cast<double>(z[i]) * z[i];
    return std::sqrt(sum);
}

Matrix columns(const Frames& frames, bool by_direction) {
    const auto dimension = static_cast<Eigen::Index>(frames.front().size());
    Matrix all(dimension, static_cast<Eigen::Index>(frames.size()));
    for (std::size_t k = 0; k < frames.size(); ++k) {
        const double norm = by_direction ? length(frames[k].data(), frames[k].size()) : 1;
        for (Eigen::Index i = 0; i < dimension; ++i)
            all(i, static_cast<Eigen::Index>(k)) =
                norm > 0 ? frames[k][static_cast<std::size_t>(i)] / norm : 0.0;
    }
    return all;
}

/// Computes the axes from the smaller of the two products of the frames with their transpose, which
/// have the same eigenvalues.
void take_axes(Matrix frames, Plane& plane) {
    const Vector mean = frames.rowwise().mean();
    frames.colwise() -= mean;
    plane.mean.assign(mean.data(), mean.data() + mean.size());
    const bool fewer_frames = frames.cols() < frames.rows();
    const Matrix products =
        fewer_frames ? Matrix(frames.transpose() * frames) : Matrix(frames * frames.transpose());
    const fit::Eigenpairs greatest = fit::greatest_eigenpairs(products, 2);
    const double all = products.trace();
    for (std::size_t k = 0; k < 2; ++k) {
        const auto at = static_cast<Eigen::Index>(k);
        Vector axis = fewer_frames ? Vector(frames * greatest.vectors.col(at))
                                   : Vector(greatest.vectors.col(at));
        if (axis.norm() > 0) axis.normalize();
        Eigen::Index largest = 0;
        axis.cwiseAbs().maxCoeff(&largest);
        if (axis[largest] < 0) axis = -axis;
        plane.axes[k].assign(axis.data(), axis.data() + axis.size());
        plane.explained[k] = all > 0 ? std::max(greatest.values[at], 0.0) / all : 0;
    }
}

/// A point of two numbers is its own plane.
void take_numbers(Plane& plane) {
    plane.mean = {0, 0};
    plane.axes = {std::vector<double>{1, 0}, {0, 1}};
}

/// Returns the points of several numbers from which the predicates measure.
std::vector<Index> points_to_draw(const check::Model& model, const std::vector<Index>& predicates) {
    std::set<Index> points;
    for (const Index p : predicates)
        for (const Index d : model.predicates[p].distances())
            if (model.point_of(d).dimension > 1) points.insert(model.distances[d].point);
    return {points.begin(), points.end()};
}

}  // namespace

std::array<float, 2> Plane::operator()(const float* z) const {
    const double norm = by_direction ? length(z, mean.size()) : 1;
    std::array<float, 2> at{};
    for (std::size_t k = 0; k < 2; ++k) {
        double sum = 0;
        for (std::size_t i = 0; i < mean.size(); ++i)
            sum += axes[k][i] * ((norm > 0 ? z[i] / norm : 0) - mean[i]);
        at[k] = static_cast<float>(sum);
    }
    return at;
}

diag::Result<std::vector<Plane>> planes(const check::Model& model,
                                        const std::vector<Index>& predicates,
                                        const std::vector<std::string>& paths,
                                        const episodes::ReadOptions& reading) {
    fit::fix_order_of_sums();
    const std::vector<Index> points = points_to_draw(model, predicates);
    const plan::Plan measuring = plan::measuring(model, predicates);
    const std::size_t read = std::min(paths.size(), kPlaneEpisodes);
    std::vector<Frames> frames(points.size());
    episodes::Follower follower(measuring);
    for (std::size_t i = 0; i < read && !points.empty(); ++i) {
        auto recording = episodes::Recording::open({&model, measuring.inputs},
                                                   paths[i * paths.size() / read], reading);
        if (!recording) return recording.failure();
        std::vector<EvenFrames> of_points(points.size(), EvenFrames(kMostFrames / read));
        const auto done = episodes::replay(*recording, {&follower}, [&] {
            for (std::size_t k = 0; k < points.size(); ++k)
                if (const float* z = follower.evaluator().point(points[k]))
                    of_points[k].add(z, model.points[points[k]].dimension);
            return true;
        });
        if (!done) return done.failure();
        for (std::size_t k = 0; k < points.size(); ++k) of_points[k].move_to(frames[k]);
    }
    std::vector<Plane> found;
    for (std::size_t k = 0; k < points.size(); ++k) {
        if (frames[k].size() < 2) continue;
        Plane plane;
        plane.point = points[k];
        plane.by_direction = model.points[points[k]].dimension > 2 && only_angles(model, points[k]);
        if (model.points[points[k]].dimension == 2)
            take_numbers(plane);
        else
            take_axes(columns(frames[k], plane.by_direction), plane);
        found.push_back(std::move(plane));
    }
    return found;
}

}  // namespace etlc::report
