#include "data/recordings/image_arrays.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <vector>

#include "data/arrays/archive.hpp"
#include "data/arrays/array.hpp"
#include "data/arrays/npy_header.hpp"
#include "data/frames/protocol.hpp"
#include "data/hdf5/hdf5.hpp"
#include "data/recordings/open.hpp"
#include "data/text/quote.hpp"
#include "data/traces/trace_formats.hpp"

namespace etlc::data {
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
    const auto& shape = header.shape;
    const bool has_form = holds_images(header) || (grey == Grey::taken && header.shape.size() == 3);
    const bool fits = has_form && shape[1] > 0 && shape[2] > 0 &&
                      std::max(shape[1], shape[2]) <= frames::kMaxExtent &&
                      shape[1] * shape[2] <= frames::kMaxPixels;
    if (fits) return std::nullopt;
    return Failure{Code::trace_shape, fmt::format("has shape {}, expected {}", shape_text(shape),
                                                  expected_images(grey))};
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
    const auto archive = Archive::open({path, {}, false});
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
    return open_hdf5_images(file, path.substr(std::min(file.size() + 1, path.size())), name,
                            grey == Grey::taken);
}

}  // namespace etlc::data
