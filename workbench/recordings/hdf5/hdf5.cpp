#include "recordings/hdf5/hdf5.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <optional>

#include "data/arrays/array.hpp"
#include "data/text/text.hpp"
#include "data/traces/trace_formats.hpp"
#include "recordings/records/protocol.hpp"
#include "recordings/records/records.hpp"

namespace etlc::recordings {

using namespace data;
namespace {

using diag::Code;
using diag::Failure;
using records::Tag;

diag::Result<std::shared_ptr<Records>> start(const std::string& path,
                                             const std::vector<std::string>& arguments,
                                             Code no_channel = Code::no_such_channel) {
    const Records::Codes codes = {Code::unreadable_trace, Code::malformed_trace_array, no_channel,
                                  Code::trace_elements};
    return Records::start("etlc-read-hdf5", "ETLC_HDF5_READER", "HDF5", codes, path, arguments);
}

/// One line of a `shapes` record.
struct Shape {
    bool absent = false;
    bool bools = false;
    std::vector<std::uint64_t> dimensions;
};

std::optional<Shape> parse_shape(std::string_view line) {
    Shape shape;
    if (line == "absent") {
        shape.absent = true;
        return shape;
    }
    shape.bools = line.starts_with("bool");
    const std::string_view kind = shape.bools ? "bool" : "number";
    if (!line.starts_with(kind)) return {};
    line.remove_prefix(kind.size());
    while (!line.empty()) {
        std::uint64_t n = 0;
        const auto [end, error] = std::from_chars(line.data() + 1, line.data() + line.size(), n);
        if (line[0] != ' ' || error != std::errc() || shape.dimensions.size() == 32) return {};
        shape.dimensions.push_back(n);
        line.remove_prefix(static_cast<std::size_t>(end - line.data()));
    }
    return shape;
}

/// Reads the end; a failure may follow the last row.
std::optional<Failure> why_not_ended(Records& records) {
    const auto tag = records.next();
    if (!tag) return tag.failure();
    return *tag == Tag::end ? std::nullopt : std::optional(records.nonsense());
}

/// Reads the shapes of so many channels.
diag::Result<std::vector<Shape>> shapes_of(Records& records, std::size_t count) {
    const auto tag = records.next();
    if (!tag) return tag.failure();
    std::vector<Shape> shapes;
    for (std::string_view text = records.bytes(); !text.empty();) {
        const std::size_t end = text.find('\n');
        auto shape = end == text.npos ? std::nullopt : parse_shape(text.substr(0, end));
        if (!shape) return records.nonsense();
        shapes.push_back(std::move(*shape));
        text.remove_prefix(end + 1);
    }
    if (*tag != Tag::shapes || shapes.size() != count) return records.nonsense();
    return shapes;
}

/// The rows of all channels, side by side; channels read them in step.
class JointRows {
public:
    JointRows(std::shared_ptr<Records> records, std::size_t width, std::uint64_t steps)
        : records_(std::move(records)), steps_(steps), row_(width) {}

    /// Returns row `step`, which is the current or the next one.
    diag::Result<const double*> row(std::uint64_t step) {
        if (step < taken_) return row_.data();
        const std::size_t bytes = row_.size() * sizeof(double);
        if (at_ == records_->bytes().size() || taken_ == 0) {
            const auto tag = records_->next();
            if (!tag) return tag.failure();
            if (*tag != Tag::rows || records_->bytes().empty() ||
                records_->bytes().size() % bytes != 0)
                return records_->nonsense();
            at_ = 0;
        }
        std::memcpy(row_.data(), records_->bytes().data() + at_, bytes);
        at_ += bytes;
        if (++taken_ < steps_) return row_.data();
        if (auto failure = why_not_ended(*records_)) return *failure;
        return row_.data();
    }

private:
    std::shared_ptr<Records> records_;
    std::uint64_t steps_;
    std::uint64_t taken_ = 0;
    std::vector<double> row_;
    std::size_t at_ = 0;  ///< place in the bytes of the record
};

class ChannelRows final : public Rows {
public:
    ChannelRows(std::shared_ptr<JointRows> joint, std::size_t offset)
        : joint_(std::move(joint)), offset_(offset) {}

    diag::Result<const double*> next() override {
        const auto row = joint_->row(step_++);
        if (!row) return row.failure();
        return *row + offset_;
    }

private:
    std::shared_ptr<JointRows> joint_;
    std::size_t offset_;
    std::uint64_t step_ = 0;
};

/// Images in records, which may be cut anywhere within an image.
class RecordedFrames final : public FrameSource {
public:
    RecordedFrames(std::shared_ptr<Records> records, const std::vector<std::uint64_t>& shape)
        : records_(std::move(records)), shape_(shape) {}

    diag::Result<bool> next(Frame& frame) override {
        if (taken_ == shape_[0]) {
            if (auto failure = why_not_ended(*records_)) return *failure;
            return false;
        }
        frame.height = static_cast<std::uint32_t>(shape_[1]);
        frame.width = static_cast<std::uint32_t>(shape_[2]);
        frame.rgb.clear();
        const bool is_grey = shape_.size() == 3;
        const std::size_t size = std::size_t{frame.height} * frame.width * (is_grey ? 1 : 3);
        while (frame.rgb.size() < size) {
            const auto tag = records_->next();
            if (!tag) return tag.failure();
            const std::string& bytes = records_->bytes();
            if (*tag != Tag::rows || bytes.empty() || bytes.size() > size - frame.rgb.size())
                return records_->nonsense();
            frame.rgb += bytes;
        }
        if (is_grey) frame.rgb = in_colour(frame.rgb);
        ++taken_;
        return true;
    }

    std::optional<std::uint64_t> count() const override { return shape_[0]; }

private:
    std::shared_ptr<Records> records_;
    std::vector<std::uint64_t> shape_;
    std::uint64_t taken_ = 0;
};

}  // namespace

diag::Result<std::vector<std::string>> list_hdf5(const std::string& path,
                                                 const std::string& pattern) {
    auto records = start(path, {"list", path, pattern});
    if (!records) return records.failure();
    std::vector<std::string> names;
    for (;;) {
        const auto tag = (*records)->next();
        if (!tag) return tag.failure();
        if (*tag == Tag::end) break;
        if (*tag != Tag::name || names.size() == records::kMaxNames) return (*records)->nonsense();
        const std::string& name = (*records)->bytes();
        if (in_quotes(name) != "'" + name + "'")
            return Failure{
                Code::malformed_trace_array,
                fmt::format("has a group with a name that cannot be printed or is too long: {}",
                            in_quotes(name))};
        names.push_back(name);
    }
    if (names.empty())
        return Failure{Code::unreadable_trace,
                       fmt::format("none of its groups matches {}", in_quotes(pattern))};
    return names;
}

diag::Result<std::unique_ptr<Trace>> open_hdf5_trace(const std::string& path,
                                                     const std::string& group,
                                                     const std::vector<Channel>& channels) {
    std::vector<std::string> arguments = {"read", path, group};
    for (const Channel& channel : channels)
        arguments.insert(arguments.end(), {std::to_string(channel.width), channel.name,
                                           std::string(are_times(channel) ? records::kTimes
                                                       : channel.optional ? records::kOptional
                                                                          : records::kNeeded)});
    auto records = start(path, arguments);
    if (!records) return records.failure();
    const auto shapes = shapes_of(**records, channels.size());
    if (!shapes) return shapes.failure();

    std::vector<Feed> feeds;
    std::vector<std::size_t> offsets;
    std::size_t width = 0;
    std::uint64_t steps = 0;
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const Shape& shape = (*shapes)[c];
        offsets.push_back(width);
        feeds.push_back({channels[c], 0, nullptr});
        if (shape.absent && !channels[c].optional) return (*records)->nonsense();
        if (shape.absent) continue;
        if (auto failure = check_array(shape.dimensions, shape.bools, channels[c])) return *failure;
        feeds[c].steps = steps = shape.dimensions[0];
        width += channels[c].width;
    }
    const auto joint = std::make_shared<JointRows>(std::move(*records), width, steps);
    for (std::size_t c = 0; c < channels.size(); ++c)
        if (!(*shapes)[c].absent) feeds[c].rows = std::make_unique<ChannelRows>(joint, offsets[c]);
    return open_array_trace(std::move(feeds));
}

diag::Result<std::unique_ptr<FrameSource>> open_hdf5_images(const std::string& path,
                                                            const std::string& group,
                                                            const std::string& name,
                                                            bool with_grey) {
    auto records = start(path, {with_grey ? "grey_images" : "images", path, group, name},
                         Code::no_such_camera);
    if (!records) return records.failure();
    const auto shapes = shapes_of(**records, 1);
    if (!shapes) return shapes.failure();
    const std::vector<std::uint64_t>& shape = (*shapes)[0].dimensions;
    if (!is_shape_of_images(shape, with_grey))
        return Failure{Code::trace_shape,
                       fmt::format("the images have shape {}, expected (steps, rows, columns, 3)",
                                   shape_text(shape))};
    return std::unique_ptr<FrameSource>(
        std::make_unique<RecordedFrames>(std::move(*records), shape));
}

}  // namespace etlc::recordings
