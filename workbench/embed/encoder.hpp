// A running encoder: a network in etlc-embed, or a command of the user.
// Takes: frames, of whole sources or one by one. Gives: one embedding per frame, in order. Keeps
// true: all embeddings are finite and have the dimension that the encoder declared; an encoder may
// process several frames at a time.
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
#include "diag/diag.hpp"
#include "recordings/frames/frames.hpp"

namespace etlc::embed {

/// How encoders are run.
struct Running {
    std::string command;  ///< --encoder-cmd; empty: etlc-embed runs the model
    int max_silence_seconds = 600;
    std::string onnxruntime;  ///< --onnxruntime; empty: etlc-embed looks for it
    std::string kind;         ///< its name in fingerprints, once `settle` has found it
};

/// An error in the frames or in the encoder.
struct Trouble {
    diag::Failure failure;
    bool of_encoder = true;
    std::uint64_t frame = 0;  ///< the frame, where the frames are at fault
};

/// Makes a diagnostic about an encoder, at its model and its declaration.
diag::Diagnostic of_encoder(const diag::Failure& failure, const check::Model& model,
                            const check::Encoder& encoder);

/// Finds the library that runs networks, unless a command encodes.
std::optional<diag::Failure> settle(Running& running);

/// Replaces this process by the encoder: frames on standard input, embeddings on standard output.
/// Returns why it cannot be run. `model_path`: as in Encoder::start.
diag::Failure become(const check::Encoder& encoder, const std::string& model_path,
                     const Running& running);

class Encoder {
public:
    /// Receives the embeddings of a source, row by row.
    using Done = std::function<void(std::vector<float>)>;

    /// `model_path`: relative to the working directory.
    static diag::Result<std::unique_ptr<Encoder>> start(const check::Encoder& encoder,
                                                        const std::string& model_path,
                                                        const Running& running);

    /// Passes it all frames of a source. `done` is called when their embeddings are complete, at
    /// the latest by `finish`, `passed` for each frame; messages call the source `name`.
    std::optional<Trouble> add(
        recordings::FrameSource& frames, const std::string& name, Done done,
        const std::function<void()>& passed = [] {});
    /// Passes it one frame. `done` is called by a later `take`. Fails where it has written more
    /// embeddings than it got frames: none may belong to its frame.
    std::optional<diag::Failure> add(const recordings::Frame& frame, const std::string& name,
                                     Done done);
    /// Takes the embeddings that have arrived.
    std::optional<diag::Failure> take() { return take(false); }
    /// Returns whether it has made the embeddings of all frames so far.
    bool is_idle() const { return taken_ == given_; }
    /// Waits for the embeddings of all frames so far.
    std::optional<diag::Failure> take_all() { return take(true); }
    /// The program that runs, for Child::await.
    data::Child& child() { return *child_; }
    /// Ends the input and waits for all embeddings.
    std::optional<Trouble> finish();

    /// Returns whether it wrote more embeddings than it got frames, which `finish` finds: perhaps
    /// none belongs to its frame.
    bool has_surplus() const { return has_surplus_; }

    /// Returns the dimension, 0 before it is known.
    std::uint32_t dimension() const { return dimension_; }

private:
    struct Job {
        std::string name;
        std::uint64_t frames = 0;
        bool complete = false;  ///< all frames were passed
        std::vector<float> rows;
        Done done;
    };

    Encoder(const check::Encoder& encoder, const Running& running,
            std::unique_ptr<data::Child> child)
        : name_(encoder.name),
          expected_(encoder.dimension),
          is_command_(!running.command.empty()),
          child_(std::move(child)) {}

    /// Reads the embeddings that have arrived; with `all`, waits for those of all frames.
    std::optional<diag::Failure> take(bool all);
    std::optional<diag::Failure> pass(const recordings::Frame& frame);
    std::optional<diag::Failure> take_dimension();
    std::optional<diag::Failure> take_row(Job& job);
    void finish_jobs();
    diag::Failure stopped();
    diag::Failure surplus() const;

    std::string name_;
    std::uint32_t expected_;  ///< dimension of its inputs; 0 where it has none
    bool is_command_;
    std::unique_ptr<data::Child> child_;
    std::uint32_t dimension_ = 0;
    bool has_surplus_ = false;
    std::uint64_t given_ = 0;  ///< frames
    std::uint64_t taken_ = 0;  ///< embeddings
    std::deque<Job> jobs_;
    std::string bytes_;  ///< one row
};

}  // namespace etlc::embed
