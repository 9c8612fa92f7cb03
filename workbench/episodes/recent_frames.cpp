#include "episodes/recent_frames.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "check/points/points.hpp"

namespace etlc::episodes {

namespace {

/// Written so that compilers vectorise it.
bool is_sound(const check::Input& input, const std::vector<float>& values) {
    bool sound = true;
    for (const float x : values) sound &= std::abs(x) <= std::numeric_limits<float>::max();
    if (!sound || !input.has_range) return sound;
    return std::all_of(values.begin(), values.end(),
                       [&](float x) { return input.range.contains(x); });
}

}  // namespace

RecentFrames::RecentFrames(const check::Model& model, const std::vector<Index>& points)
    : model_(model) {
    std::set<Index> inputs;
    for (const Index point : points) {
        inputs.insert(model.points[point].inputs.begin(), model.points[point].inputs.end());
        most_ = std::max<std::size_t>(most_, check::longest_delay(model, point));
    }
    inputs_.assign(inputs.begin(), inputs.end());
}

void RecentFrames::push(const std::vector<execute::Sample>& samples) {
    last_ = &samples;
    if (most_ == 0) return;
    std::vector<execute::Sample> frame;
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

/// Returns nothing before the first frame.
const std::vector<execute::Sample>* RecentFrames::at(std::size_t ago) const {
    if (ago == 0) return last_;
    return ago < frames_.size() ? &frames_[ago] : nullptr;
}

bool RecentFrames::append(Index index, std::size_t ago, std::vector<float>& values) const {
    const check::Point& point = model_.points[index];
    if (point.is_delayed()) return append(point.inner, ago + point.steps, values);
    if (point.is_joined())
        return std::all_of(point.parts.begin(), point.parts.end(),
                           [&](Index part) { return append(part, ago, values); });
    const std::vector<execute::Sample>* const frame = at(ago);
    if (frame == nullptr) return false;
    for (const Index input : point.inputs) {
        const execute::Sample& sample = (*frame)[input];
        if (!sample.present) return false;
        if (!is_sound(model_.inputs[input], sample.values)) return false;
        values.insert(values.end(), sample.values.begin(), sample.values.end());
    }
    return true;
}

}  // namespace etlc::episodes
