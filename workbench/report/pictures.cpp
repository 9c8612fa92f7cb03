#include "report/pictures.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "data/arrays/archive.hpp"
#include "data/arrays/npy_header.hpp"
#include "data/files/file.hpp"
#include "data/frames/frames.hpp"
#include "data/recordings/open.hpp"
#include "data/text/quote.hpp"
#include "report/blob.hpp"

namespace etlc::report {

namespace {

using diag::Code;
using diag::Failure;

constexpr std::string_view kEpisode = "{episode}";
constexpr std::size_t kMostPictures = 120;
constexpr std::uint64_t kLargestFile = 64U << 20U;

std::string big_endian(std::uint32_t number) {
    std::string bytes;
    for (const unsigned shift : {24U, 16U, 8U, 0U})
        bytes += static_cast<char>(number >> shift & 0xFFU);
    return bytes;
}

std::string chunk(const std::string& name, const std::string& data) {
    const std::string checked = name + data;
    const uLong sum =
        crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()));
    return big_endian(static_cast<std::uint32_t>(data.size())) + checked +
           big_endian(static_cast<std::uint32_t>(sum));
}

/// Filters the rows: none, or (`up`) the differences from the row above.
std::string filtered(const Picture& picture, bool up) {
    const std::size_t row = std::size_t{3} * picture.width;
    std::string bytes;
    for (std::size_t y = 0; y < picture.height; ++y) {
        bytes += up ? '\2' : '\0';
        for (std::size_t i = y * row; i < (y + 1) * row; ++i)
            bytes += static_cast<char>(picture.pixels[i] -
                                       (up && y > 0 ? picture.pixels[i - row] : '\0'));
    }
    return bytes;
}

std::string png(const Picture& picture) {
    const std::string plain = deflated(filtered(picture, false));
    const std::string up = deflated(filtered(picture, true));
    const std::string head = big_endian(picture.width) + big_endian(picture.height) +
                             std::string("\x08\x02\x00\x00\x00", 5);  // 8 bits, RGB
    return "\x89PNG\r\n\x1a\n" + chunk("IHDR", head) +
           chunk("IDAT", up.size() < plain.size() ? up : plain) + chunk("IEND", "");
}

/// Returns evenly spaced steps, including the first and the last.
std::vector<std::uint64_t> chosen_steps(std::uint64_t steps, std::size_t most) {
    const std::size_t n = std::min<std::size_t>(steps, most);
    std::vector<std::uint64_t> chosen;
    for (std::size_t i = 0; i < n; ++i)
        chosen.push_back(n == 1 ? 0 : (i * (steps - 1) + (n - 1) / 2) / (n - 1));
    return chosen;
}

/// Returns the name of an episode: ep3 for "runs/ep3.npz", demo_7 for "set.h5:data/demo_7".
std::string name_of(const std::string& episode) {
    const std::string file = data::trace_file(episode);
    if (file.size() == episode.size()) return std::filesystem::path(file).stem().string();
    return std::filesystem::path(episode.substr(file.size() + 1)).filename().string();
}

std::string not_one_a_step(std::uint64_t found, std::uint64_t steps) {
    return fmt::format("found {}, expected {}, one per step", diag::counted(found, "picture"),
                       steps);
}

Failure of_file(const Failure& failure, const std::string& path) {
    return {failure.code, path + ": " + failure.message};
}

diag::Result<std::string> address_of(const std::string& path) {
    const auto bytes = data::read_file(path, kLargestFile, Code::not_pictures);
    if (!bytes) return of_file(bytes.failure(), path);
    if (bytes->starts_with("\x89PNG")) return "data:image/png;base64," + base64(*bytes);
    if (bytes->starts_with("\xFF\xD8\xFF")) return "data:image/jpeg;base64," + base64(*bytes);
    return Failure{Code::not_pictures, path + ": expected a PNG or JPEG file"};
}

diag::Result<Pictures> from_files(const std::vector<std::string>& paths, std::uint64_t steps,
                                  std::uint64_t most_bytes) {
    Pictures result;
    if (paths.size() != steps) {
        result.why = not_one_a_step(paths.size(), steps);
        return result;
    }
    // The size of the first determines how many fit.
    const auto first = address_of(paths[0]);
    if (!first) return first.failure();
    const std::size_t most = std::min<std::uint64_t>(kMostPictures, most_bytes / first->size());
    for (const std::uint64_t step : chosen_steps(steps, most)) {
        auto file = address_of(paths[step]);
        if (!file) return file.failure();
        result.steps.push_back(step);
        result.files.push_back(std::move(*file));
    }
    if (result.steps.empty()) result.why = "a single picture is larger than the space for pictures";
    return result;
}

std::string sheet(const std::vector<Picture>& pictures, std::size_t stride) {
    Picture all{pictures[0].width, 0, ""};
    for (std::size_t i = 0; i < pictures.size(); i += stride) {
        all.height += pictures[i].height;
        all.pixels += pictures[i].pixels;
    }
    return address(all);
}

/// Puts as many of the pictures as fit on one sheet, evenly.
Pictures on_a_sheet(const std::vector<Picture>& pictures, const std::vector<std::uint64_t>& steps,
                    std::uint64_t most_bytes) {
    Pictures result;
    result.width = pictures[0].width;
    result.height = pictures[0].height;
    for (std::size_t stride = 1; stride <= steps.size(); stride *= 2) {
        std::string text = sheet(pictures, stride);
        if (text.size() > most_bytes) continue;
        result.files.push_back(std::move(text));
        for (std::size_t i = 0; i < steps.size(); i += stride) result.steps.push_back(steps[i]);
        return result;
    }
    result.why = "a single picture is larger than the space for pictures";
    return result;
}

/// Decodes all frames, to count them.
diag::Result<Pictures> from_video(const std::string& path, const Length& length,
                                  std::uint64_t most_bytes) {
    const auto decoded = data::open_video(path, {.rate = length.rate});
    if (!decoded) return of_file(decoded.failure(), path);
    const std::vector<std::uint64_t> chosen = chosen_steps(length.steps, kMostPictures);
    std::vector<Picture> pictures;
    data::Frame frame;
    std::uint64_t count = 0;
    for (;; ++count) {
        const auto more = (*decoded)->next(frame);
        if (!more) return of_file(more.failure(), path);
        if (!*more) break;
        if (pictures.size() < chosen.size() && chosen[pictures.size()] == count)
            pictures.push_back(shrunk(frame.rgb, frame.width, frame.height, 3, kMostPixels));
    }
    if (count == length.steps) return on_a_sheet(pictures, chosen, most_bytes);
    Pictures result;
    result.why = not_one_a_step(count, length.steps);
    return result;
}

/// An array of bytes: T x H x W x 3, or T x H x W.
struct Film {
    std::uint64_t steps = 0;
    std::uint32_t height = 0;
    std::uint32_t width = 0;
    std::uint32_t channels = 3;

    std::size_t bytes() const { return std::size_t{height} * width * channels; }
};

std::optional<Film> film_of(const data::NpyHeader& header) {
    constexpr std::uint64_t kMostSide = 1U << 14U;
    const auto& shape = header.shape;
    const bool is_grey = shape.size() == 3;
    if (!is_grey && (shape.size() != 4 || shape[3] != 3)) return std::nullopt;
    if (header.element != data::Element::u8 || header.fortran_order) return std::nullopt;
    if (shape[1] == 0 || shape[2] == 0 || shape[1] > kMostSide || shape[2] > kMostSide)
        return std::nullopt;
    return Film{shape[0], static_cast<std::uint32_t>(shape[1]),
                static_cast<std::uint32_t>(shape[2]), is_grey ? 1U : 3U};
}

/// Reads the pictures of these steps and shrinks them.
diag::Result<std::vector<Picture>> small_pictures(data::ByteSource& source, const Film& film,
                                                  const std::vector<std::uint64_t>& steps) {
    std::vector<Picture> pictures;
    std::string frame(film.bytes(), '\0');
    std::uint64_t at = 0;
    for (const std::uint64_t step : steps) {
        for (; at <= step; ++at) {
            const auto read = source.read(frame.data(), frame.size());
            if (!read) return read.failure();
            if (*read < frame.size())
                return Failure{Code::not_pictures, "the array ends before its last picture"};
        }
        pictures.push_back(shrunk(frame, film.width, film.height, film.channels, kMostPixels));
    }
    return pictures;
}

diag::Result<Pictures> from_array(const std::string& key, const std::string& episode,
                                  std::uint64_t steps, std::uint64_t most_bytes) {
    if (!episode.ends_with(".npz"))
        return Failure{Code::not_pictures, "arrays of pictures are read only from .npz files"};
    Pictures result;
    const auto archive = data::Archive::open({episode, {}});
    if (!archive) return archive.failure();
    const auto& keys = archive->keys();
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
        result.why = fmt::format("has no array {}", data::in_quotes(key));
        return result;
    }
    const auto source = archive->member(key);
    if (!source) return source.failure();
    const auto header = data::read_npy_header(**source);
    if (!header) return header.failure();
    const auto film = film_of(*header);
    if (!film)
        return Failure{Code::not_pictures,
                       fmt::format("array {} has shape {} of {}, expected T x H x W x 3 of uint8",
                                   data::in_quotes(key), data::shape_text(header->shape),
                                   data::name(header->element))};
    if (film->steps != steps) {
        result.why = not_one_a_step(film->steps, steps);
        return result;
    }
    const std::vector<std::uint64_t> chosen = chosen_steps(steps, kMostPictures);
    const auto pictures = small_pictures(**source, *film, chosen);
    if (!pictures) return pictures.failure();
    return on_a_sheet(*pictures, chosen, most_bytes);
}

}  // namespace

bool FramesOption::is_pattern() const {
    const auto ends = [&](std::string_view end) { return text.ends_with(end); };
    return text.find_first_of("*?[{") != std::string::npos || ends(".png") || ends(".jpg") ||
           ends(".jpeg") || data::is_video(text);
}

bool check_pattern(const FramesOption& option, std::size_t episodes, diag::Sink& sink) {
    if (!option.is_pattern() || episodes == 1 || option.text.find(kEpisode) != std::string::npos)
        return true;
    sink.report(data::in_file(
        {Code::no_frames, fmt::format("names the same pictures for each of {}, expected {} in it, "
                                      "which stands for an episode's name",
                                      diag::counted(episodes, "episode"), kEpisode)},
        "--frames " + option.text));
    return false;
}

std::vector<std::string> files_of_frames(const FramesOption& option, const std::string& episode) {
    std::string pattern = option.text;
    const std::string name = data::literal(name_of(episode));
    for (std::size_t at = 0; (at = pattern.find(kEpisode, at)) != std::string::npos;
         at += name.size())
        pattern.replace(at, kEpisode.size(), name);
    return data::paths_matching(pattern).value_or(std::vector<std::string>{});
}

std::uint64_t Pictures::bytes() const {
    std::uint64_t sum = 0;
    for (const std::string& file : files) sum += file.size();
    return sum;
}

diag::Result<Pictures> pictures_of(const FramesOption& option, const std::string& episode,
                                   const Length& length, std::uint64_t most_bytes) {
    if (!option.is_pattern()) return from_array(option.text, episode, length.steps, most_bytes);
    const std::vector<std::string> paths = files_of_frames(option, episode);
    if (paths.size() == 1 && data::is_video(paths[0]))
        return from_video(paths[0], length, most_bytes);
    return from_files(paths, length.steps, most_bytes);
}

std::string address(const Picture& picture) {
    return "data:image/png;base64," + base64(png(picture));
}

}  // namespace etlc::report
