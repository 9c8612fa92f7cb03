#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "check/model/model.hpp"
#include "data/arrays/npz_writer.hpp"
#include "data/files/file.hpp"
#include "data/recordings/open.hpp"
#include "data/text/number.hpp"
#include "data/text/quote.hpp"
#include "data/traces/csv.hpp"
#include "diag/diag.hpp"
#include "embed/embed.hpp"
#include "embed/recordings.hpp"

namespace etlc::embed {

namespace {

using check::Index;
using check::kNone;
using diag::Code;

using data::Channel;
using diag::Failure;

/// Returns how a column is read, by its name.
diag::Result<Channel> channel_of(const check::Model& model, const data::ElementName& column) {
    Channel channel{column.array, column.element ? Channel::Kind::vector : Channel::Kind::scalar, 1,
                    false};
    if (column.array.starts_with("truth.")) channel.kind = Channel::Kind::boolean;
    for (const check::Input& input : model.inputs) {
        if (input.name != column.array) continue;
        if (input.encoder != check::kNone)
            return Failure{
                Code::no_such_channel,
                fmt::format("has a column {}, which '{}' makes of the frames",
                            data::in_quotes(column.array), model.encoders[input.encoder].name),
                1, 1};
        if (input.type == check::InputType::boolean) channel.kind = Channel::Kind::boolean;
    }
    return channel;
}

diag::Result<std::vector<Channel>> channels_of(const check::Model& model, const std::string& path) {
    auto source = data::open_file(path);
    if (!source) return source.failure();
    data::CsvReader header(std::move(*source));
    const auto read = header.next();
    if (!read) return read.failure();
    std::vector<Channel> channels;
    for (std::size_t i = 0; *read && i < header.cells(); ++i) {
        const data::ElementName column = data::element_name(header.cell(i));
        const auto same = [&](const Channel& other) { return other.name == column.array; };
        const auto known = std::find_if(channels.begin(), channels.end(), same);
        if (known != channels.end()) {
            known->width = std::max(known->width, column.element.value_or(0) + 1);
            continue;
        }
        auto channel = channel_of(model, column);
        if (!channel) return channel.failure();
        channel->width = column.element.value_or(0) + 1;
        channels.push_back(std::move(*channel));
    }
    constexpr std::uint32_t kMostElements = 1U << 20U;  // no row of a file has more cells
    for (const Channel& channel : channels)
        if (channel.width > kMostElements)
            return Failure{Code::trace_shape,
                           fmt::format("has a column {}[{}], expected at most {} elements",
                                       channel.name, channel.width - 1, kMostElements),
                           1, 1};
    return channels;
}

/// Reads every `stride`-th step of a trace.
diag::Result<std::vector<Array>> read_arrays(data::Trace& trace,
                                             const std::vector<Channel>& channels,
                                             std::uint64_t stride) {
    std::vector<Array> arrays;
    for (const Channel& channel : channels)
        arrays.push_back({channel.name, channel.width, {}, channel.kind == Channel::Kind::vector});
    data::Sample sample;
    for (std::uint64_t step = 0;; ++step) {
        const auto more = trace.next(sample);
        if (!more) return more.failure();
        if (!*more) return arrays;
        if (step % stride != 0) continue;
        for (std::size_t c = 0; c < arrays.size(); ++c)
            for (const double value : sample.values[c])
                arrays[c].values.push_back(sample.present[c]
                                               ? static_cast<float>(value)
                                               : std::numeric_limits<float>::quiet_NaN());
    }
}

/// Reads the .csv file beside a recording: a column for each number, a row for each step, labels in
/// columns `truth.NAME`, empty cells for missing samples. A column with the name of an encoded
/// input is a failure. Failures have E08 codes and do not repeat the path.
diag::Result<std::vector<Array>> arrays_beside(const check::Model& model, const std::string& path) {
    const auto channels = channels_of(model, path);
    if (!channels) return channels.failure();
    const auto trace = data::open_trace(path, *channels);
    if (!trace) return trace.failure();
    return read_arrays(**trace, *channels, 1);
}

/// Reads the inputs that no encoder makes, and the labels that `names` has, from
/// `recording.columns`. Failures do not repeat the path.
diag::Result<std::vector<Array>> arrays_in(const check::Model& model, const Recording& recording,
                                           const data::NamesInFile& names) {
    std::vector<Channel> channels;
    for (const check::Input& input : model.inputs) {
        if (input.encoder != check::kNone) continue;
        Channel channel{input.name, Channel::Kind::scalar, 1, false};
        if (input.type == check::InputType::boolean) channel.kind = Channel::Kind::boolean;
        if (input.is_embedding()) {
            channel.kind = Channel::Kind::vector;
            channel.width = input.dimension;
        }
        channels.push_back(std::move(channel));
    }
    for (const auto& [name, in_file] : names)
        if (name.starts_with("truth."))
            channels.push_back({name, Channel::Kind::boolean, 1, false});
    if (channels.empty()) return std::vector<Array>{};
    const auto trace = data::open_trace(recording.columns, data::renamed(channels, names));
    if (!trace) return trace.failure();
    return read_arrays(**trace, channels, recording.stride);
}

/// Returns the inputs that an encoder makes.
std::vector<Index> encoded_inputs(const check::Model& model) {
    std::vector<Index> found;
    for (Index i = 0; i < model.inputs.size(); ++i)
        if (model.inputs[i].encoder != kNone) found.push_back(i);
    return found;
}

class Episodes {
public:
    Episodes(const check::Model& model, const embedded::File& file,
             const std::vector<Recording>& recordings, const Request& request, const Keep& keep,
             diag::Sink& sink)
        : model_(model),
          recordings_(recordings),
          request_(request),
          keep_(keep),
          sink_(sink),
          inputs_(encoded_inputs(model)),
          made_(recordings.size()) {
        for (const Index input : inputs_) {
            const std::string& encoder = model.encoders[model.inputs[input].encoder].name;
            marks_[model.inputs[input].name] = embedded::fingerprint(file.encoders.at(encoder));
        }
    }

    bool make() {
        if (recordings_.empty()) return true;
        if (!has_cameras()) return false;
        std::map<Index, std::unique_ptr<Encoder>> encoders;
        for (const Index input : inputs_)
            if (!start(model_.inputs[input].encoder, encoders)) return false;
        for (std::size_t r = 0; r < recordings_.size(); ++r) {
            for (const Index input : inputs_)
                if (!add(*encoders.at(model_.inputs[input].encoder), r, input)) return false;
            if (inputs_.empty() && !failed_) write(r);
        }
        for (const auto& [index, encoder] : encoders)
            if (auto trouble = encoder->finish()) return fail(trouble->failure, model_path(index));
        return !failed_;
    }

private:
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

    /// Runs all encoders at once, so that episodes are written while the next ones are read.
    bool start(Index index, std::map<Index, std::unique_ptr<Encoder>>& encoders) {
        std::unique_ptr<Encoder>& place = encoders[index];
        if (place) return true;
        auto started = Encoder::start(model_.encoders[index], model_path(index), request_.running);
        if (!started) return fail(started.failure(), model_path(index));
        place = std::move(*started);
        return true;
    }

    bool add(Encoder& encoder, std::size_t recording, Index input) {
        const Recording& from = recordings_[recording];
        auto frames = from.open(model_.inputs[input].name);
        if (!frames) return fail(frames.failure(), from.path);
        const auto trouble =
            encoder.add(**frames, from.path, [this, recording, input](std::vector<float> rows) {
                take(recording, input, std::move(rows));
            });
        if (!trouble) return !failed_;
        if (trouble->of_encoder)
            return fail(trouble->failure, model_path(model_.inputs[input].encoder));
        const bool is_of_images = from.files.size() > 1;
        return fail(trouble->failure, is_of_images && trouble->frame < from.files.size()
                                          ? from.files[trouble->frame]
                                          : from.path);
    }

    /// Writes the episode once it has all its inputs.
    void take(std::size_t recording, Index input, std::vector<float> rows) {
        made_[recording][input] = std::move(rows);
        if (made_[recording].size() == inputs_.size() && !failed_) write(recording);
    }

    void write(std::size_t r) {
        const Recording& from = recordings_[r];
        std::vector<Array> arrays;
        for (auto& [index, values] : made_[r]) {
            const check::Input& input = model_.inputs[index];
            arrays.push_back({input.name, input.dimension, std::move(values), true});
        }
        made_[r].clear();
        if (!add_columns(from, arrays)) {
            failed_ = true;
            return;
        }
        std::vector<data::ArchiveMember> members;
        if (!marks_.empty()) members.push_back({"embedded.json", embedded::write_marks(marks_)});
        const std::uint64_t steps = arrays.empty() ? 0 : steps_of(arrays[0]);
        for (const Array& array : arrays) {
            if (steps_of(array) != steps && !failed_)
                failed_ =
                    !fail({Code::trace_shape, fmt::format("'{}' has {}, '{}' has {}", array.name,
                                                          diag::counted(steps_of(array), "step"),
                                                          arrays[0].name, steps)},
                          from.beside.empty() ? from.path : from.beside);
            std::vector<std::uint64_t> shape = {steps_of(array)};
            if (array.is_vector) shape.push_back(array.width);
            members.push_back({array.name + ".npy", data::npy_bytes(shape, array.values)});
        }
        if (!failed_) failed_ = !keep_(from, data::npz_bytes(members));
    }

    static std::uint64_t steps_of(const Array& array) { return array.values.size() / array.width; }

    /// Reads what a recording has besides frames; reports an error and returns false where it
    /// cannot.
    bool add_columns(const Recording& from, std::vector<Array>& arrays) {
        const auto add = [&](diag::Result<std::vector<Array>> read, const std::string& path) {
            if (!read) sink_.report(data::in_trace(read.failure(), path));
            if (read) std::move(read->begin(), read->end(), std::back_inserter(arrays));
            return bool(read);
        };
        if (!from.columns.empty() && !add(arrays_in(model_, from, request_.names), from.columns))
            return false;
        return from.beside.empty() || add(arrays_beside(model_, from.beside), from.beside);
    }

    bool fail(const diag::Failure& failure, const std::string& path) {
        sink_.report(data::in_file(failure, path));
        return false;
    }

    const check::Model& model_;
    const std::vector<Recording>& recordings_;
    const Request& request_;
    const Keep& keep_;
    diag::Sink& sink_;
    std::vector<Index> inputs_;
    embedded::Marks marks_;
    std::vector<std::map<Index, std::vector<float>>> made_;  ///< by recording
    bool failed_ = false;
};

}  // namespace

bool embed_recordings(const check::Model& model, const embedded::File& file,
                      const std::vector<Recording>& recordings, const Request& request,
                      const Keep& keep, diag::Sink& sink) {
    return Episodes(model, file, recordings, request, keep, sink).make();
}

}  // namespace etlc::embed
