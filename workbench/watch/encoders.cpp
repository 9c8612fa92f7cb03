#include "watch/encoders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "artifacts/embedded.hpp"
#include "check/encoders/encoders.hpp"
#include "data/files/file.hpp"
#include "recordings/frames/frames.hpp"

namespace etlc::watch {

namespace {

using check::Index;
using diag::Code;
using diag::Failure;

constexpr int kPatienceMilliseconds = 1000;

}  // namespace

std::unique_ptr<Encoders> Encoders::start(const check::Model& model,
                                          const std::vector<Index>& inputs, embed::Request request,
                                          const Stop& stop, diag::Sink& sink) {
    std::unique_ptr<Encoders> encoders(
        new Encoders(model, request.running.max_silence_seconds, sink));
    if (!encoders->is_suitable(inputs, request) || !encoders->start_all(inputs, request.running) ||
        !encoders->compare_all(stop))
        return nullptr;
    return encoders;
}

bool Encoders::fail(Index input, const Failure& failure) {
    const check::Encoder& encoder = model_.encoders[model_.inputs[input].encoder];
    sink_.report(data::in_file(failure, data::beside(model_.file.path(), encoder.model)))
        .note(encoder.span, fmt::format("'{}' is declared here", encoder.name));
    return false;
}

/// Compares fingerprints, as for episodes, and refuses two cameras.
bool Encoders::is_suitable(const std::vector<Index>& inputs, embed::Request& request) {
    check::Model now;
    now.name = model_.name;
    now.file = model_.file;
    now.encoders = model_.encoders;
    if (!embed::describe_encoders(now, request, sink_)) return false;
    std::set<Index> seen;
    for (const Index i : inputs) {
        const check::Input& input = model_.inputs[i];
        const embedded::Marks marks = {{input.name, now.encoders[input.encoder].fingerprint}};
        if (const auto other = check::other_encoder(model_, input, input.name, marks))
            return fail(i, *other);
        if (!seen.insert(input.encoder).second) {
            sink_.report(Code::encoder_use, input.span,
                         fmt::format("'{}' is by the encoder of another input, so of another "
                                     "camera, and this is a video of one",
                                     input.name));
            return false;
        }
    }
    return true;
}

bool Encoders::start_all(const std::vector<Index>& inputs, const embed::Running& running) {
    for (const Index i : inputs) {
        const check::Encoder& encoder = model_.encoders[model_.inputs[i].encoder];
        auto started = embed::Encoder::start(
            encoder, data::beside(model_.file.path(), encoder.model), running);
        if (!started) return fail(i, started.failure());
        children_.push_back(&(*started)->child());
        encoders_[i] = std::move(*started);
    }
    return true;
}

/// A command's fingerprint says nothing of the command, so that embeddings decide.
bool Encoders::compare_all(const Stop& stop) {
    for (const auto& [input, encoder] : encoders_)
        if (!compare(input, stop)) return false;
    return true;
}

bool Encoders::compare(Index input, const Stop& stop) {
    const check::Encoder& of = model_.encoders[model_.inputs[input].encoder];
    embed::Encoder& encoder = *encoders_.at(input);
    const std::vector<float>& expected = of.references;
    for (std::uint32_t frame = 0; frame < embedded::kReferenceFrames; ++frame) {
        std::vector<float> row;
        bool is_there = false;
        const auto done = [&](std::vector<float> found) {
            row = std::move(found);
            is_there = true;
        };
        if (auto failure =
                encoder.add(recordings::reference_frame(frame), "a reference frame", done))
            return fail(input, *failure);
        given_ = std::chrono::steady_clock::now();
        while (!is_there) {
            data::Child::await({&encoder.child()}, {stop.descriptor()}, kPatienceMilliseconds);
            if (stop.is_asked() || !take(input)) return false;
        }
        if (expected.size() != embedded::kReferenceFrames * row.size())
            return fail(input, {Code::other_encoder,
                                fmt::format("what '{}' made of the reference frames is not known: "
                                            "run etlc embed again",
                                            of.name)});
        const double difference =
            embedded::relative_difference(row.data(), &expected[frame * row.size()], row.size());
        if (difference > embedded::kSameEncoder)
            return fail(input, {Code::other_encoder,
                                fmt::format("'{}' makes other embeddings than when `etlc embed` "
                                            "ran: of reference frame {} they differ by {:.2g}, "
                                            "expected at most {}",
                                            of.name, frame, difference, embedded::kSameEncoder)});
    }
    return true;
}

bool Encoders::give(const recordings::Frame& frame) {
    waiting_ = encoders_.size();
    given_ = std::chrono::steady_clock::now();
    for (const auto& [input, encoder] : encoders_) {
        const auto done = [this, at = input](std::vector<float> row) {
            rows_[at] = std::move(row);
            --waiting_;
        };
        if (auto failure = encoder->add(frame, "the video", done)) return fail(input, *failure);
    }
    return true;
}

bool Encoders::take() {
    const auto takes = [this](const auto& one) { return take(one.first); };
    return waiting_ == 0 || std::all_of(encoders_.begin(), encoders_.end(), takes);
}

bool Encoders::take(Index input) {
    embed::Encoder& encoder = *encoders_.at(input);
    const bool is_late = std::chrono::steady_clock::now() - given_ > most_;
    if (auto failure = encoder.child().is_over() ? encoder.take_all() : encoder.take())
        return fail(input, *failure);
    if (!is_late || encoder.is_idle()) return true;
    return fail(input,
                {Code::encoder_failed,
                 fmt::format("'{}' has made no embedding of a frame for {}; it has "
                             "to write, and flush, one after every frame",
                             model_.encoders[model_.inputs[input].encoder].name,
                             diag::counted(static_cast<std::uint64_t>(most_.count()), "second"))});
}

}  // namespace etlc::watch
