#include <fmt/format.h>

#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "check/model/model.hpp"
#include "data/arrays/archive.hpp"
#include "data/files/atomic_file.hpp"
#include "data/files/file.hpp"
#include "diag/diag.hpp"
#include "embed/embed.hpp"
#include "embed/recordings.hpp"

namespace etlc::embed {

namespace {

using check::Index;
using check::kNone;
using diag::Code;
using diag::Failure;

std::vector<Index> encoded_inputs(const check::Model& model) {
    std::vector<Index> found;
    for (Index i = 0; i < model.inputs.size(); ++i)
        if (model.inputs[i].encoder != kNone) found.push_back(i);
    return found;
}

/// The embeddings of an input, and what they were made from.
struct Made {
    std::string origin;
    std::vector<float> rows;
};

class Episodes {
public:
    Episodes(const check::Model& model, const embedded::File& file,
             const std::vector<Recording>& recordings, const Request& request, diag::Sink& sink)
        : model_(model),
          recordings_(recordings),
          request_(request),
          sink_(sink),
          inputs_(encoded_inputs(model)),
          earlier_(request.running, request.version),
          made_(recordings.size()),
          is_encoded_(recordings.size(), inputs_.empty()),
          is_stored_(recordings.size()) {
        progress_.of = recordings.size();
        for (const Index input : inputs_) {
            const std::string& encoder = model.encoders[model.inputs[input].encoder].name;
            marks_[model.inputs[input].name] = embedded::fingerprint(file.encoders.at(encoder));
        }
    }

    std::optional<Progress> make() {
        if (!has_cameras()) return std::nullopt;
        add_all();
        // An error keeps the episodes before it, however far the encoders had got.
        for (const auto& [index, encoder] : encoders_) {
            if (!encoder) continue;
            auto trouble = index == broken_ ? std::nullopt : encoder->finish();
            if (trouble) stop(trouble->failure, model_path(index));
            if (encoder->has_surplus()) discard();
        }
        if (first_trouble_ && !has_failed()) sink_.report(*first_trouble_);
        if (first_trouble_ || has_failed()) return std::nullopt;
        return progress_;
    }

private:
    bool has_failed() const { return end_ < recordings_.size(); }

    void add_all() {
        for (std::size_t r = 0; r < end_; ++r) {
            for (const Index input : inputs_)
                if (!add(r, input)) return;
            if (inputs_.empty()) write(r);
        }
    }

    /// Removes the episodes of this call, also those that it kept: the same encoder made them.
    void discard() {
        std::error_code error;
        for (std::size_t r = 0; r < recordings_.size(); ++r)
            if (is_stored_[r])
                std::filesystem::remove(episode_path(request_.folder, recordings_[r]), error);
    }

    /// Refuses two inputs by one encoder for a recording with one camera.
    bool has_cameras() {
        for (const Recording& recording : recordings_) {
            if (!recording.has_one_camera) continue;
            for (const Index one : inputs_)
                for (const Index other : inputs_) {
                    const check::Input& a = model_.inputs[one];
                    const check::Input& b = model_.inputs[other];
                    if (one >= other || a.encoder != b.encoder) continue;
                    sink_
                        .report(Code::encoder_use, b.span,
                                fmt::format("'{}' and '{}' are by the same encoder, so of two "
                                            "cameras, and {} is of one",
                                            a.name, b.name, recording.path))
                        .note("expected recordings with a camera for each input");
                    return false;
                }
        }
        return true;
    }

    std::string model_path(Index encoder) const {
        return data::beside(model_.file.path(), model_.encoders[encoder].model);
    }

    /// Returns the encoder, which runs from its first frames on; null where it cannot be started.
    /// All run at once, so that episodes are written while the next ones are read.
    Encoder* running(Index index) {
        std::unique_ptr<Encoder>& place = encoders_[index];
        if (place) return place.get();
        auto started = Encoder::start(model_.encoders[index], model_path(index), request_.running);
        if (started)
            place = std::move(*started);
        else
            stop(started.failure(), model_path(index));
        return place.get();
    }

    /// Keeps the embeddings that the episode has, or encodes the frames.
    bool add(std::size_t recording, Index index) {
        const check::Input& input = model_.inputs[index];
        const Recording& from = recordings_[recording];
        // Before the frames are read, so that a file that changes meanwhile is encoded again.
        std::string origin = earlier_.origin(from, input.name, marks_.at(input.name));
        auto known =
            embeddings_in(episode_path(request_.folder, from), input.name, input.dimension, origin);
        if (!known) return encode(recording, index, std::move(origin));
        take(recording, index, {std::move(origin), std::move(*known)});
        return !has_failed();
    }

    bool encode(std::size_t recording, Index index, std::string origin) {
        const check::Input& input = model_.inputs[index];
        const Recording& from = recordings_[recording];
        Encoder* const encoder = running(input.encoder);
        if (encoder == nullptr) return false;
        auto frames = from.open(input.name);
        if (!frames) return stop(frames.failure(), from.path);
        is_encoded_[recording] = true;
        const auto done = [this, recording, index, origin](auto rows) {
            take(recording, index, {origin, std::move(rows)});
        };
        const auto trouble = encoder->add(**frames, from.path, done, [this] {
            ++progress_.frames;
            show();
        });
        if (!trouble) return !has_failed();
        if (trouble->of_encoder) {
            broken_ = input.encoder;
            return stop(trouble->failure, model_path(input.encoder));
        }
        const bool is_of_images = from.files.size() > 1;
        return stop(trouble->failure, is_of_images && trouble->frame < from.files.size()
                                          ? from.files[trouble->frame]
                                          : from.path);
    }

    /// Writes the episode once it has all its inputs.
    void take(std::size_t recording, Index input, Made made) {
        made_[recording][input] = std::move(made);
        if (made_[recording].size() == inputs_.size() && recording < end_) write(recording);
    }

    void show() const {
        if (request_.progress) request_.progress(progress_);
    }

    void write(std::size_t r) {
        if (!is_written(r)) end_ = r;
        ++progress_.done;
        if (is_encoded_[r]) ++progress_.encoded;
        show();
    }

    bool is_written(std::size_t r) {
        const Recording& from = recordings_[r];
        std::vector<Array> arrays;
        embedded::Origins origins;
        for (auto& [index, made] : made_[r]) {
            const check::Input& input = model_.inputs[index];
            if (!made.origin.empty())
                origins[input.name] = bound(made.origin, input.dimension, made.rows);
            arrays.push_back({input.name, input.dimension, std::move(made.rows), true});
        }
        made_[r].clear();
        if (!add_columns(from, arrays)) return false;
        std::vector<data::ArchiveMember> members;
        if (!marks_.empty())
            members.push_back({"embedded.json", embedded::write_marks(marks_, origins)});
        const std::uint64_t steps = arrays.empty() ? 0 : steps_of(arrays[0]);
        for (const Array& array : arrays) {
            if (steps_of(array) != steps)
                return fail({Code::trace_shape, fmt::format("'{}' has {}, '{}' has {}", array.name,
                                                            diag::counted(steps_of(array), "step"),
                                                            arrays[0].name, steps)},
                            from.beside.empty() ? from.path : from.beside);
            std::vector<std::uint64_t> shape = {steps_of(array)};
            if (array.is_vector) shape.push_back(array.width);
            members.push_back({array.name + ".npy", data::npy_bytes(shape, array.values)});
        }
        is_stored_[r] = store(from, data::npz_bytes(members));
        return is_stored_[r];
    }

    /// Writes an episode, unless the file has these bytes.
    bool store(const Recording& from, const std::string& bytes) {
        const std::string path = episode_path(request_.folder, from);
        const auto old = data::read_file(path, bytes.size(), Code::unwritable_output);
        if (old && *old == bytes) return true;
        const auto failure = data::write_file_atomically(path, bytes, Code::unwritable_output);
        return !failure || fail(*failure, path);
    }

    static std::uint64_t steps_of(const Array& array) { return array.values.size() / array.width; }

    /// Reads what a recording has besides frames; reports an error and returns false where it
    /// cannot.
    bool add_columns(const Recording& from, std::vector<Array>& arrays) {
        const auto add = [&](diag::Result<std::vector<Array>> read, const std::string& path) {
            if (!read) sink_.report(recordings::in_trace(read.failure(), path));
            if (read) std::move(read->begin(), read->end(), std::back_inserter(arrays));
            return bool(read);
        };
        if (!from.columns.empty() && !add(arrays_in(model_, from, request_.names), from.columns))
            return false;
        return from.beside.empty() || add(arrays_beside(model_, from.beside), from.beside);
    }

    bool fail(const Failure& failure, const std::string& path) {
        sink_.report(data::in_file(failure, path));
        return false;
    }

    /// Ends the reading of recordings. The error is reported after those of earlier episodes.
    bool stop(const Failure& failure, const std::string& path) {
        if (!first_trouble_) first_trouble_ = data::in_file(failure, path);
        return false;
    }

    const check::Model& model_;
    const std::vector<Recording>& recordings_;
    const Request& request_;
    diag::Sink& sink_;
    std::vector<Index> inputs_;
    embedded::Marks marks_;
    Earlier earlier_;
    std::map<Index, std::unique_ptr<Encoder>> encoders_;
    std::vector<std::map<Index, Made>> made_;  ///< by recording
    std::vector<bool> is_encoded_;  ///< by recording; true where there is nothing to encode
    std::vector<bool> is_stored_;   ///< by recording
    Progress progress_;
    std::size_t end_ = recordings_.size();  ///< an error in this recording was reported
    Index broken_ = kNone;                  ///< the encoder that failed
    std::optional<diag::Diagnostic> first_trouble_;
};

}  // namespace

std::string episode_path(const std::string& folder, const Recording& recording) {
    return (std::filesystem::path(folder) / (recording.episode + ".npz")).string();
}

std::optional<Progress> embed_recordings(const check::Model& model, const embedded::File& file,
                                         const std::vector<Recording>& recordings,
                                         const Request& request, diag::Sink& sink) {
    if (recordings.empty()) return Progress{};
    return Episodes(model, file, recordings, request, sink).make();
}

}  // namespace etlc::embed
