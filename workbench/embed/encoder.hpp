// A running encoder: a network in etlc-embed, or a command of the user.
// Takes: frames. Gives: their embeddings. Keeps true: there is one embedding a frame, in their
// order, all of the dimension that the encoder said first, all finite; an encoder is started once
// and may look at as many frames at a time as it likes.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "data/files/child.hpp"
#include "data/frames/frames.hpp"
#include "diag/diag.hpp"

namespace etlc::embed {

/// How encoders are run.
struct Running {
    std::string command;  ///< of --encoder-cmd; empty: etlc-embed runs the model
    int max_silence_seconds = 600;
    std::string onnxruntime;  ///< of --onnxruntime; empty: etlc-embed looks for it
    std::string kind;         ///< what fingerprints say of it, once `settle` has found out
};

/// What went wrong, with the frames or with the encoder.
struct Trouble {
    diag::Failure failure;
    bool of_encoder = true;
    std::uint64_t frame = 0;  ///< of the frames: which one
};

/// Finds the library that runs networks, where no command does.
std::optional<diag::Failure> settle(Running& running);

class Encoder {
public:
    /// Gets the embeddings of a source, row by row.
    using Done = std::function<void(std::vector<float>)>;

    /// `model_path`: from where etlc runs.
    static diag::Result<std::unique_ptr<Encoder>> start(const check::Encoder& encoder,
                                                        const std::string& model_path,
                                                        const Running& running);

    /// Gives it all frames of the source. `done` is called once their embeddings are there, at the
    /// latest by `finish`; `name` is what messages call the source.
    std::optional<Trouble> add(data::FrameSource& frames, const std::string& name, Done done);
    /// There are no more frames.
    std::optional<Trouble> finish();

    /// 0 as long as it has not said.
    std::uint32_t dimension() const { return dimension_; }

private:
    struct Job {
        std::string name;
        std::uint64_t frames = 0;
        bool complete = false;  ///< all frames are given
        std::vector<float> rows;
        Done done;
    };

    Encoder(const check::Encoder& encoder, const Running& running,
            std::unique_ptr<data::Child> child)
        : name_(encoder.name),
          expected_(encoder.dimension),
          is_command_(!running.command.empty()),
          child_(std::move(child)) {}

    /// Takes the embeddings that are there; with `all`, waits for those of all frames.
    std::optional<diag::Failure> take(bool all);
    std::optional<diag::Failure> take_dimension();
    std::optional<diag::Failure> take_row(Job& job);
    void finish_jobs();
    diag::Failure stopped();

    std::string name_;
    std::uint32_t expected_;  ///< of the inputs by it; 0: there are none
    bool is_command_;
    std::unique_ptr<data::Child> child_;
    std::uint32_t dimension_ = 0;
    std::uint64_t given_ = 0;  ///< frames
    std::uint64_t taken_ = 0;  ///< embeddings
    std::deque<Job> jobs_;
    std::string bytes_;  ///< of a row
};

}  // namespace etlc::embed
