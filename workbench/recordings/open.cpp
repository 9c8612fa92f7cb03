#include <fmt/format.h>
#include <algorithm>
#include <filesystem>
#include <system_error>

#include "data/arrays/archive.hpp"
#include "data/arrays/array.hpp"
#include "data/files/file.hpp"
#include "data/text/text.hpp"
#include "data/traces/trace_formats.hpp"
#include "recordings/datasets/trace.hpp"
#include "recordings/frames/protocol.hpp"
#include "recordings/hdf5/hdf5.hpp"
#include "recordings/open.hpp"

namespace etlc::recordings {

using namespace data;

namespace {

/// Returns "; did you mean 'run_01.csv'?" where there is no such file, but one of a near name.
std::string file_meant(const std::string& file) {
    constexpr std::size_t kMost = 1000;  // an edit distance is computed to each
    std::vector<std::string> names;
    std::error_code error;
    if (std::filesystem::exists(file, error)) return "";
    const std::filesystem::path path(file);
    const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    for (std::filesystem::directory_iterator it(folder, error), end;
         !error && it != end && names.size() < kMost; it.increment(error))
        if (is_trace(it->path().string())) names.push_back(it->path().filename().string());
    std::sort(names.begin(), names.end());
    return suggestion(path.filename().string(), names);
}

/// Returns the group of FILE.h5:GROUP, empty for FILE.h5.
std::string group_in(const std::string& path, const std::string& file) {
    return path.substr(std::min(file.size() + 1, path.size()));
}

using Opened = diag::Result<std::unique_ptr<Trace>>;

Opened open_csv(const std::string& path, const std::vector<Channel>& channels) {
    auto source = open_file(path, Streams::taken);
    if (!source) return of_trace(source.failure());
    return open_csv_trace(std::move(*source), channels);
}

Opened open_hdf5(const std::string& path, const std::vector<Channel>& channels) {
    const std::string file = trace_file(path);
    return open_hdf5_trace(file, group_in(path, file), channels);
}

/// A format and the ending of its files.
struct Format {
    const char* ending;
    Opened (*open)(const std::string& path, const std::vector<Channel>& channels);
};

constexpr Format kFormats[] = {
    {".csv", open_csv}, {".npz", open_npz_trace}, {".h5", open_hdf5}, {".hdf5", open_hdf5}};

/// Finds the format of a file; null for other endings.
const Format* format_of(const std::string& file) {
    for (const Format& format : kFormats)
        if (file.ends_with(format.ending)) return &format;
    return nullptr;
}

}  // namespace

bool is_trace(const std::string& path) {
    return format_of(path) != nullptr;
}

std::string trace_endings() {
    std::vector<std::string> endings;
    for (const Format& format : kFormats) endings.emplace_back(format.ending);
    return diag::alternatives(endings);
}

diag::Failure no_steps() {
    return {diag::Code::empty_trace, "holds no step, expected at least one"};
}

diag::Diagnostic in_trace(const diag::Failure& failure, const std::string& path) {
    diag::Diagnostic result = in_file(failure, path == kStandardInput ? "standard input" : path);
    if (failure.code == diag::Code::no_such_channel)
        result.note("--map NAME=NAME_IN_FILE says what an input is called in the file");
    if (failure.code == diag::Code::no_label)
        result.note(
            "--map truth.NAME=NAME_IN_FILE says what the labels are called in the file; a 'truth' "
            "in the spec makes them of other inputs; a table labels.csv beside the files has them "
            "in rows, where !NAME says that NAME never holds");
    if (failure.code == diag::Code::video_out_of_step)
        result.note(
            "every step has a row: fill a gap with rows whose samples are missing (empty cells of "
            "a .csv file, NaN in arrays), or cut the recording there; a 'time' that is not that of "
            "the steps needs another name");
    return result;
}

diag::Result<std::unique_ptr<Trace>> open_trace(const std::string& path,
                                                const std::vector<Channel>& channels) {
    if (path == kStandardInput) return open_csv_trace(standard_input(), channels);
    if (dataset_path(path)) return open_dataset_trace(path, channels);
    if (const Format* format = format_of(trace_file(path))) {
        auto opened = format->open(path, channels);
        if (opened) return opened;
        diag::Failure failure = opened.failure();
        failure.message += file_meant(trace_file(path));
        return failure;
    }
    return diag::Failure{
        diag::Code::unknown_trace_format,
        with_dataset_meant("unknown kind of trace, expected " + trace_endings(), path)};
}

diag::Result<std::optional<bool>> recorded_success(const std::string& path) {
    std::vector<std::string> names{"next.success"};
    if (is_hdf5(trace_file(path))) names.emplace_back("@success");
    for (const std::string& name : names) {
        const auto trace = open_trace(path, {{name, Channel::Kind::boolean}});
        if (!trace && trace.failure().code == diag::Code::no_such_channel) continue;
        if (!trace) return trace.failure();
        bool succeeded = false;
        Sample sample;
        for (;;) {
            const auto more = (*trace)->next(sample);
            if (!more) return more.failure();
            if (!*more) return std::optional(succeeded);
            succeeded = succeeded || (sample.present[0] && sample.values[0][0] != 0);
        }
    }
    return std::optional<bool>();
}

std::vector<Channel> renamed(std::vector<Channel> channels, const NamesInFile& names) {
    for (Channel& channel : channels) channel.name = name_in_file(channel.name, names);
    return channels;
}

const std::string& name_in_file(const std::string& name, const NamesInFile& names) {
    const auto found = names.find(name);
    return found == names.end() ? name : found->second;
}

namespace {

using diag::Code;
using diag::Failure;

std::string expected_images(Grey grey) {
    return grey == Grey::taken ? "(steps, rows, columns, 3), or (steps, rows, columns) of grey"
                               : "(steps, rows, columns, 3)";
}

bool holds_images(const NpyHeader& header) {
    return header.element == Element::u8 && header.shape.size() == 4 && header.shape[3] == 3;
}

std::optional<Failure> check_images(const NpyHeader& header, Grey grey) {
    if (header.element != Element::u8)
        return Failure{
            Code::trace_elements,
            fmt::format("has elements of {}, expected uint8: images", data::name(header.element))};
    if (header.fortran_order)
        return Failure{Code::malformed_trace_array,
                       "is in Fortran order, expected C order: save numpy.ascontiguousarray of it"};
    if (is_shape_of_images(header.shape, grey == Grey::taken)) return std::nullopt;
    return Failure{Code::trace_shape, fmt::format("has shape {}, expected {}",
                                                  shape_text(header.shape), expected_images(grey))};
}

/// The images of an .npz file.
class ArchiveFrames final : public FrameSource {
public:
    ArchiveFrames(std::unique_ptr<ByteSource> source, const NpyHeader& header, std::string name)
        : source_(std::move(source)), header_(header), name_(std::move(name)) {}

    diag::Result<bool> next(Frame& frame) override {
        if (taken_ == header_.shape[0]) return false;
        frame.height = static_cast<std::uint32_t>(header_.shape[1]);
        frame.width = static_cast<std::uint32_t>(header_.shape[2]);
        const bool is_grey = header_.shape.size() == 3;
        frame.rgb.resize(std::size_t{frame.height} * frame.width * (is_grey ? 1 : 3));
        const auto got = source_->read(frame.rgb.data(), frame.rgb.size());
        if (!got) return of_trace(in_array(got.failure(), name_));
        if (*got < frame.rgb.size())
            return in_array({Code::malformed_trace_array,
                             fmt::format("ends in image {}, expected {}", taken_,
                                         diag::counted(header_.shape[0], "image"))},
                            name_);
        if (is_grey) frame.rgb = in_colour(frame.rgb);
        if (++taken_ < header_.shape[0]) return true;
        char more = 0;
        const auto rest = source_->read(&more, 1);  // the checksum comes with the end
        if (!rest) return of_trace(in_array(rest.failure(), name_));
        if (*rest > 0)
            return in_array({Code::malformed_trace_array, "has bytes behind its last image"},
                            name_);
        return true;
    }

    std::optional<std::uint64_t> count() const override { return header_.shape[0]; }

private:
    std::unique_ptr<ByteSource> source_;
    NpyHeader header_;
    std::string name_;
    std::uint64_t taken_ = 0;
};

/// Returns the named array, or else the only array of images.
diag::Result<std::string> camera_in(const Archive& archive, const std::string& name) {
    if (!name.empty()) return name;
    std::vector<std::string> cameras;
    for (const std::string& key : archive.keys()) {
        auto member = archive.member(key);
        if (!member) return of_trace(member.failure());
        const auto header = read_npy_header(**member);
        if (header && holds_images(*header)) cameras.push_back(key);
    }
    if (cameras.size() == 1) return cameras[0];
    if (cameras.empty())
        return Failure{
            Code::no_such_camera,
            fmt::format("has no array of images, (steps, rows, columns, 3) of uint8, but "
                        "{}",
                        listed(archive.keys()))};
    return Failure{Code::no_such_camera,
                   fmt::format("has the arrays of images {}; name one: --camera {}",
                               listed(cameras), cameras[0])};
}

diag::Result<std::unique_ptr<FrameSource>> open_npz(const std::string& path,
                                                    const std::string& name, Grey grey) {
    const auto archive = Archive::open(path);
    if (!archive) return of_trace(archive.failure());
    const auto camera = camera_in(*archive, name);
    if (!camera) return camera.failure();
    auto member = archive->member(*camera);
    if (!member) return Failure{Code::no_such_camera, member.failure().message};
    const auto header = read_npy_header(**member);
    if (!header) return of_trace(in_array(header.failure(), *camera));
    if (auto failure = check_images(*header, grey)) return in_array(*failure, *camera);
    return std::unique_ptr<FrameSource>(
        std::make_unique<ArchiveFrames>(std::move(*member), *header, *camera));
}

}  // namespace

diag::Result<std::unique_ptr<FrameSource>> open_image_array(const std::string& path,
                                                            const std::string& name, Grey grey) {
    const std::string file = trace_file(path);
    if (!is_hdf5(file)) return open_npz(path, name, grey);
    return open_hdf5_images(file, group_in(path, file), name, grey == Grey::taken);
}

}  // namespace etlc::recordings
