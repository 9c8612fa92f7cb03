#include "data/traces/hdf5.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <system_error>

#include "data/files/child.hpp"
#include "data/files/file.hpp"
#include "data/quote.hpp"
#include "data/traces/array_trace.hpp"
#include "data/traces/hdf5_protocol.hpp"

namespace etlc::data {
namespace {

namespace fs = std::filesystem;
using diag::Code;
using diag::Failure;
using hdf5::Cause;
using hdf5::Tag;

constexpr std::string_view kReader = "etlc-read-hdf5";

std::string find_reader() {
    if (const char* const path = std::getenv("ETLC_HDF5_READER")) return path;
    return helper_path(kReader);
}

Code code_of(char cause) {
    switch (static_cast<Cause>(cause)) {
        case Cause::channel: return Code::no_such_channel;
        case Cause::elements: return Code::trace_elements;
        case Cause::array:
        case Cause::file: break;
    }
    return Code::malformed_trace_array;
}

/// The reader's records, of which none is trusted.
class Records {
public:
    static diag::Result<std::shared_ptr<Records>> start(const std::string& path,
                                                        const std::vector<std::string>& arguments) {
        if (auto why = why_unreadable(path)) return Failure{Code::unreadable_trace, *why};
        std::error_code error;
        if (!fs::is_regular_file(path, error))
            return Failure{Code::unreadable_trace, "is not a regular file, as HDF5 needs it"};
        const std::string reader = find_reader();
        auto child =
            Child::start(reader, arguments, {.max_silence_seconds = hdf5::kMaxSilenceSeconds});
        if (!child)
            return Failure{
                Code::unreadable_trace,
                fmt::format("{} cannot be run, which reads HDF5 files", in_quotes(reader))};
        return std::shared_ptr<Records>(new Records(std::move(child)));
    }

    /// The next record; its bytes are in `bytes()`. What the reader says is wrong is a failure.
    diag::Result<Tag> next() {
        std::array<char, 5> head{};
        std::uint32_t length = 0;
        if (!child_->read(head.data(), head.size())) return stopped();
        std::memcpy(&length, head.data() + 1, sizeof length);
        if (length > hdf5::kMaxRecordBytes) return nonsense();
        bytes_.resize(length);
        if (!child_->read(bytes_.data(), length)) return stopped();
        const auto tag = static_cast<Tag>(head[0]);
        if (tag == Tag::failure) {
            if (length < 2) return nonsense();
            return Failure{code_of(bytes_[0]), escaped(std::string_view(bytes_).substr(1))};
        }
        return tag;
    }

    const std::string& bytes() const { return bytes_; }

    static Failure nonsense() {
        return {Code::malformed_trace_array,
                "is damaged: what came back from reading it makes no sense"};
    }

private:
    explicit Records(std::unique_ptr<Child> child) : child_(std::move(child)) {}

    Failure stopped() {
        return {Code::malformed_trace_array,
                fmt::format("is damaged or too much to read: the process that read it {}",
                            child_->ending())};
    }

    /// The reader's own words; a name from the file in them has been escaped there, yet it may be
    /// under its control.
    static std::string escaped(std::string_view text) {
        std::string result;
        for (const char c : text.substr(0, 1000)) result += c >= 0x20 && c < 0x7f ? c : '?';
        return result;
    }

    std::unique_ptr<Child> child_;
    std::string bytes_;
};

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

std::optional<std::vector<Shape>> parse_shapes(std::string_view text, std::size_t count) {
    std::vector<Shape> shapes;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        if (end == std::string_view::npos) return {};
        auto shape = parse_shape(text.substr(0, end));
        if (!shape) return {};
        shapes.push_back(std::move(*shape));
        text.remove_prefix(end + 1);
    }
    if (shapes.size() != count) return {};
    return shapes;
}

/// The rows of all channels, side by side; they are asked for in step with each other.
class JointRows {
public:
    JointRows(std::shared_ptr<Records> records, std::size_t width, std::uint64_t steps)
        : records_(std::move(records)), steps_(steps), row_(width) {}

    /// Row `step`, which is the current one or the next.
    diag::Result<const double*> row(std::uint64_t step) {
        if (step < taken_) return row_.data();
        const std::size_t bytes = row_.size() * sizeof(double);
        if (at_ == records_->bytes().size() || taken_ == 0) {
            const auto tag = records_->next();
            if (!tag) return tag.failure();
            if (*tag != Tag::rows || records_->bytes().empty() ||
                records_->bytes().size() % bytes != 0)
                return Records::nonsense();
            at_ = 0;
        }
        std::memcpy(row_.data(), records_->bytes().data() + at_, bytes);
        at_ += bytes;
        if (++taken_ < steps_) return row_.data();
        const auto tag = records_->next();  // what is wrong at the very end is wrong too
        if (!tag) return tag.failure();
        if (*tag != Tag::end) return Records::nonsense();
        return row_.data();
    }

private:
    std::shared_ptr<Records> records_;
    std::uint64_t steps_;
    std::uint64_t taken_ = 0;
    std::vector<double> row_;
    std::size_t at_ = 0;  ///< in the record's bytes
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

}  // namespace

bool is_hdf5(const std::string& path) {
    return path.ends_with(".h5") || path.ends_with(".hdf5");
}

diag::Result<std::vector<std::string>> list_hdf5(const std::string& path,
                                                 const std::string& pattern) {
    auto records = Records::start(path, {"list", path, pattern});
    if (!records) return records.failure();
    std::vector<std::string> names;
    for (;;) {
        const auto tag = (*records)->next();
        if (!tag) return tag.failure();
        if (*tag == Tag::end) break;
        if (*tag != Tag::name || names.size() == hdf5::kMaxNames) return Records::nonsense();
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
                       fmt::format("no group of it matches {}", in_quotes(pattern))};
    return names;
}

diag::Result<std::unique_ptr<Trace>> open_hdf5_trace(const std::string& path,
                                                     const std::string& group,
                                                     const std::vector<Channel>& channels) {
    std::vector<std::string> arguments = {"read", path, group};
    for (const Channel& channel : channels)
        arguments.insert(arguments.end(),
                         {std::to_string(channel.width), channel.name,
                          std::string(channel.optional ? hdf5::kOptional : hdf5::kNeeded)});
    auto records = Records::start(path, arguments);
    if (!records) return records.failure();
    const auto tag = (*records)->next();
    if (!tag) return tag.failure();
    const auto shapes = parse_shapes((*records)->bytes(), channels.size());
    if (*tag != Tag::shapes || !shapes) return Records::nonsense();

    std::vector<Feed> feeds;
    std::vector<std::size_t> offsets;
    std::size_t width = 0;
    std::uint64_t steps = 0;
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const Shape& shape = (*shapes)[c];
        offsets.push_back(width);
        feeds.push_back({channels[c], 0, nullptr});
        if (shape.absent && !channels[c].optional) return Records::nonsense();
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

}  // namespace etlc::data
