#include "episodes/recent_frames.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "check/points/project.hpp"

namespace etlc::episodes {

RecentFrames::RecentFrames(const check::Model& model, const std::vector<Index>& points)
    : model_(model) {
    std::set<Index> inputs;
    for (const Index point : points) {
        inputs.insert(model.points[point].inputs.begin(), model.points[point].inputs.end());
        most_ = std::max<std::size_t>(most_, check::longest_delay(model, point));
    }
    inputs_.assign(inputs.begin(), inputs.end());
}

void RecentFrames::push(const std::vector<plan::Sample>& samples) {
    std::vector<plan::Sample> frame;
    if (frames_.size() > most_) {
        frame = std::move(frames_.back());  // its memory is used again
        frames_.pop_back();
    }
    frame.resize(samples.size());
    for (const Index input : inputs_) frame[input] = samples[input];
    frames_.push_front(std::move(frame));
}

bool RecentFrames::read(Index point, std::vector<float>& values) const {
    values.clear();
    return append(point, 0, values);
}

bool RecentFrames::append(Index index, std::size_t ago, std::vector<float>& values) const {
    const check::Point& point = model_.points[index];
    if (point.is_delayed()) return append(point.inner, ago + point.steps, values);
    if (point.is_joined())
        return std::all_of(point.parts.begin(), point.parts.end(),
                           [&](Index part) { return append(part, ago, values); });
    if (ago >= frames_.size()) return false;
    for (const Index input : point.inputs) {
        const plan::Sample& sample = frames_[ago][input];
        if (!sample.present) return false;
        const check::Range& range = model_.inputs[input].range;
        bool sound = true;  // without branches, so that it vectorises
        for (const float x : sample.values) sound &= std::isfinite(x) && range.contains(x);
        if (!sound) return false;
        values.insert(values.end(), sample.values.begin(), sample.values.end());
    }
    return true;
}

}  // namespace etlc::episodes
