// The encoders of a live source.
// Takes: a frame at a time. Gives: the embeddings of the inputs that monitors read. Keeps true: no
// frame is encoded before every encoder has shown that it is the one of calibration: its
// fingerprint is that of the spec's embeddings, and what it makes of the reference frames too.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "embed/embed.hpp"
#include "recordings/frames/frames.hpp"
#include "watch/watch.hpp"

namespace etlc::watch {

class Encoders {
public:
    /// Starts the encoders of these inputs; the arguments outlive them. Returns nothing after an
    /// error, which it reports, and where somebody has asked for the end.
    static std::unique_ptr<Encoders> start(const check::Model& model,
                                           const std::vector<check::Index>& inputs,
                                           embed::Request request, const Stop& stop,
                                           diag::Sink& sink);

    /// Passes a frame to all encoders, which have finished the one before.
    bool give(const recordings::Frame& frame);
    /// Takes the embeddings that have arrived; false after an error.
    bool take();
    /// Returns whether all embeddings of the last frame are there.
    bool are_done() const { return waiting_ == 0; }
    /// Returns the embedding of an input of the last frame.
    const std::vector<float>& embedding(check::Index input) const { return rows_.at(input); }
    /// The programs that run, for data::Child::await.
    const std::vector<data::Child*>& children() const { return children_; }

private:
    Encoders(const check::Model& model, int seconds, diag::Sink& sink)
        : model_(model), sink_(sink), most_(seconds) {}

    bool is_suitable(const std::vector<check::Index>& inputs, embed::Request& request);
    bool start_all(const std::vector<check::Index>& inputs, const embed::Running& running);
    bool compare_all(const Stop& stop);
    bool compare(check::Index input, const Stop& stop);
    /// Takes what has arrived of an encoder; false where it has failed, or is silent too long.
    bool take(check::Index input);
    bool fail(check::Index input, const diag::Failure& failure);

    const check::Model& model_;
    diag::Sink& sink_;
    std::map<check::Index, std::unique_ptr<embed::Encoder>> encoders_;  ///< by input
    std::map<check::Index, std::vector<float>> rows_;                   ///< by input
    std::vector<data::Child*> children_;
    std::chrono::seconds most_;  ///< --encoder-timeout
    std::chrono::steady_clock::time_point given_;
    std::size_t waiting_ = 0;  ///< embeddings of the last frame that are to come
};

}  // namespace etlc::watch
