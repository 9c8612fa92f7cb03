#include "report/pictures.hpp"

#include <zlib.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include "check/encoders/encoded.hpp"
#include "data/files/file.hpp"
#include "data/text/text.hpp"
#include "episodes/recording.hpp"
#include "fit/collect.hpp"
#include "plan/plan.hpp"
#include "recordings/datasets/dataset.hpp"
#include "recordings/datasets/trace.hpp"
#include "recordings/hdf5/hdf5.hpp"
#include "recordings/open.hpp"
#include "report/document.hpp"
#include "report/report.hpp"
#include "report/tracks.hpp"

namespace etlc::report {

namespace {

using diag::Code;
using diag::Failure;

namespace fs = std::filesystem;

constexpr std::string_view kEpisode = "{episode}";
constexpr std::size_t kMostPictures = 120;
constexpr std::uint64_t kLargestFile = 64U << 20U;
constexpr const char* kTooLarge = "a single picture is larger than the space for pictures";

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

/// Orders a list so that each beginning of it is spread over all of it.
std::vector<std::uint64_t> spread(const std::vector<std::uint64_t>& list) {
    std::size_t stride = 1;
    while (stride < list.size()) stride *= 2;
    std::vector<std::uint64_t> result;
    for (; stride > 0 && !list.empty(); stride /= 2)
        for (std::size_t i = 0; i < list.size(); i += stride)
            if (result.empty() || i % (2 * stride) != 0) result.push_back(list[i]);
    return result;
}

/// Returns the steps of pictures, the most important first: as many as there is room for are shown.
std::vector<std::uint64_t> steps_in_order(std::uint64_t steps,
                                          const std::vector<std::uint64_t>& telling) {
    std::vector<std::uint64_t> evenly;
    const std::size_t n = std::min<std::size_t>(steps, kMostPictures);
    for (std::size_t i = 0; i < n; ++i)
        evenly.push_back(n == 1 ? 0 : (i * (steps - 1) + (n - 1) / 2) / (n - 1));
    std::vector<std::uint64_t> wanted = {0, steps - 1};
    wanted.insert(wanted.end(), telling.begin(), telling.end());
    const std::vector<std::uint64_t> others = spread(evenly);
    wanted.insert(wanted.end(), others.begin(), others.end());
    std::vector<std::uint64_t> order;
    std::set<std::uint64_t> known;
    for (const std::uint64_t step : wanted)
        if (order.size() < kMostPictures && known.insert(step).second) order.push_back(step);
    return order;
}

/// Returns the first `n` steps of an order, sorted.
std::vector<std::uint64_t> first_of(std::vector<std::uint64_t> order, std::size_t n) {
    order.resize(std::min(n, order.size()));
    std::sort(order.begin(), order.end());
    return order;
}

/// Returns the name of an episode: ep3 for "runs/ep3.npz", demo_7 for "set.h5:data/demo_7".
std::string name_of(const std::string& episode) {
    const std::string file = data::trace_file(episode);
    if (file.size() == episode.size()) return fs::path(file).stem().string();
    return fs::path(episode.substr(file.size() + 1)).filename().string();
}

/// Returns the files that a pattern names for an episode, in order.
std::vector<std::string> files_of(std::string pattern, const std::string& episode) {
    const std::string name = data::literal(name_of(episode));
    for (std::size_t at = 0; (at = pattern.find(kEpisode, at)) != std::string::npos;
         at += name.size())
        pattern.replace(at, kEpisode.size(), name);
    return data::paths_matching(pattern).value_or(std::vector<std::string>{});
}

std::string not_one_a_step(std::uint64_t found, std::uint64_t steps) {
    return fmt::format("found {}, expected {}, one per step", diag::counted(found, "picture"),
                       steps);
}

Failure of_file(const Failure& failure, const std::string& path) {
    return {failure.code, path.empty() ? failure.message : path + ": " + failure.message};
}

diag::Result<std::string> address_of(const std::string& path) {
    const auto bytes = data::read_file(path, kLargestFile, Code::not_pictures);
    if (!bytes) return of_file(bytes.failure(), path);
    if (bytes->starts_with("\x89PNG")) return "data:image/png;base64," + base64(*bytes);
    if (bytes->starts_with("\xFF\xD8\xFF")) return "data:image/jpeg;base64," + base64(*bytes);
    return Failure{Code::not_pictures, path + ": expected a PNG or JPEG file"};
}

diag::Result<Pictures> from_files(const std::vector<std::string>& paths,
                                  const std::vector<std::uint64_t>& order,
                                  std::uint64_t most_bytes) {
    Pictures result;
    // The size of the first determines how many fit.
    const auto first = address_of(paths[0]);
    if (!first) return first.failure();
    for (const std::uint64_t step : first_of(order, most_bytes / first->size())) {
        auto file = address_of(paths[step]);
        if (!file) return file.failure();
        result.steps.push_back(step);
        result.files.push_back(std::move(*file));
    }
    if (result.steps.empty()) result.why = kTooLarge;
    return result;
}

/// Puts as many of the pictures as fit on one sheet, the most important ones.
Pictures on_a_sheet(const std::map<std::uint64_t, Picture>& pictures,
                    const std::vector<std::uint64_t>& order, std::uint64_t most_bytes) {
    Pictures result;
    result.width = pictures.begin()->second.width;
    result.height = pictures.begin()->second.height;
    for (std::size_t n = order.size(); n > 0; n /= 2) {
        result.steps = first_of(order, n);
        Picture all{result.width, 0, ""};
        for (const std::uint64_t step : result.steps) {
            all.height += pictures.at(step).height;
            all.pixels += pictures.at(step).pixels;
        }
        result.files = {address(all)};
        if (result.bytes() <= most_bytes) return result;
    }
    return {{}, {}, 0, 0, kTooLarge};
}

/// Reads all frames, to count them.
diag::Result<Pictures> from_frames(Film& film, const Length& length,
                                   const std::vector<std::uint64_t>& order,
                                   std::uint64_t most_bytes) {
    const std::set<std::uint64_t> wanted(order.begin(), order.end());
    std::map<std::uint64_t, Picture> pictures;
    recordings::Frame frame;
    std::uint64_t count = 0;
    for (;; ++count) {
        const auto more = film.frames->next(frame);
        if (!more) return of_file(more.failure(), film.path);
        if (!*more) break;
        if (wanted.contains(count))
            pictures.emplace(count, shrunk(frame.rgb, frame.width, frame.height, 3, kMostPixels));
    }
    if (count == length.steps) return on_a_sheet(pictures, order, most_bytes);
    return Pictures{{}, {}, 0, 0, not_one_a_step(count, length.steps)};
}

// ---- frames of data sets ------------------------------------------------------------------------

/// Returns the episode of the data set that shows this one. `etlc embed` names it after the set:
/// "pick-000003".
diag::Result<std::string> dataset_episode(const std::string& set, const std::string& episode) {
    if (const auto which = data::dataset_path(episode)) {
        std::error_code ignored;
        if (set.empty() || fs::equivalent(which->folder, set, ignored)) return episode;
        return Failure{Code::no_frames,
                       fmt::format("is an episode of another data set than {}", set)};
    }
    const std::string name = name_of(episode);
    const std::size_t end = name.find_last_not_of("0123456789") + 1;
    const auto number = data::parse_whole<std::uint64_t>(std::string_view(name).substr(end));
    if (!number)
        return Failure{Code::no_frames,
                       fmt::format("the name of the episode, {}, does not end with the number of "
                                   "an episode of {}",
                                   data::in_quotes(name), set)};
    const std::string before = name.substr(0, end);
    const std::string expected = recordings::name_of_folder(set) + "-";
    if (before.ends_with('-') && before != expected)
        return Failure{Code::no_frames,
                       fmt::format("the episode {} is named after another data set than {}: "
                                   "expected {}{}",
                                   data::in_quotes(name), set, expected, name.substr(end))};
    return recordings::episode_path(set, *number);
}

diag::Result<Film> open_dataset_film(const FramesOption& option, const std::string& episode,
                                     const Length& length) {
    const auto of_set = dataset_episode(option.text, episode);
    if (!of_set) return of_set.failure();
    const auto found = recordings::find_episode(*of_set);
    if (!found) return of_file({Code::no_frames, found.failure().message}, *of_set);
    const auto camera = recordings::camera_of(*found->set, option.camera);
    if (!camera) return of_file(camera.failure(), *of_set);
    const auto stride = recordings::rows_a_step(*found->set, length.rate);
    if (!stride) return of_file(stride.failure(), *of_set);
    const std::uint64_t steps = (found->episode->length + *stride - 1) / *stride;
    if (steps != length.steps)
        return Failure{Code::no_frames,
                       fmt::format("{}: {}", *of_set, not_one_a_step(steps, length.steps))};
    Film film;
    film.path = *of_set;
    auto frames = recordings::open_clip(*found->set, *found->episode, *camera, *stride);
    if (!frames) return of_file(frames.failure(), *of_set);
    film.frames = std::move(*frames);
    return film;
}

diag::Result<Film> open_array_film(const std::string& array, const std::string& episode,
                                   std::uint64_t steps) {
    const std::string file = data::trace_file(episode);
    if (!file.ends_with(".npz") && !data::is_hdf5(file))
        return Failure{Code::not_pictures,
                       "arrays of pictures are read only from .npz and .h5 files"};
    auto frames = recordings::open_image_array(episode, array, recordings::Grey::taken);
    if (!frames)
        return Failure{
            frames.failure().code == Code::no_such_camera ? Code::no_frames : Code::not_pictures,
            frames.failure().message};
    if ((*frames)->count() != steps)
        return Failure{Code::no_frames, not_one_a_step((*frames)->count().value_or(0), steps)};
    Film film;
    film.frames = std::move(*frames);
    return film;
}

}  // namespace

bool FramesOption::is_pattern() const {
    const auto ends = [&](std::string_view end) { return text.ends_with(end); };
    return text.find_first_of("*?[{") != std::string::npos || ends(".png") || ends(".jpg") ||
           ends(".jpeg") || recordings::is_video(text);
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

std::uint64_t Pictures::bytes() const {
    std::uint64_t sum = 0;
    for (const std::string& file : files) sum += file.size();
    return sum;
}

bool names_frames(const FramesOption& option, const std::string& episode) {
    if (!option.text.empty()) return true;
    if (!data::dataset_path(episode)) return false;
    const auto found = recordings::find_episode(episode);
    return found && !found->set->cameras().empty();
}

diag::Result<Film> open_film(const FramesOption& option, const std::string& episode,
                             const Length& length, std::uint64_t from) {
    if (option.text.empty() || data::is_dataset(option.text))
        return open_dataset_film(option, episode, length);
    if (!option.is_pattern()) return open_array_film(option.text, episode, length.steps);
    Film film;
    std::vector<std::string> paths = files_of(option.text, episode);
    if (paths.size() == 1 && recordings::is_video(paths[0])) {
        film.path = paths[0];
        auto frames = recordings::open_video(paths[0], {.rate = length.rate, .skipped = from});
        if (!frames) return of_file(frames.failure(), film.path);
        film.frames = std::move(*frames);
        film.next = from;
        film.can_skip = true;
        return film;
    }
    if (paths.size() != length.steps)
        return Failure{Code::no_frames, not_one_a_step(paths.size(), length.steps)};
    film.images = std::move(paths);
    return film;
}

diag::Result<Pictures> pictures_of(const FramesOption& option, const std::string& episode,
                                   const Length& length, const std::vector<std::uint64_t>& telling,
                                   std::uint64_t most_bytes) {
    auto film = open_film(option, episode, length, 0);
    if (!film && film.failure().code == Code::no_frames)
        return Pictures{{}, {}, 0, 0, film.failure().message};
    if (!film) return film.failure();
    const std::vector<std::uint64_t> order = steps_in_order(length.steps, telling);
    return film->frames ? from_frames(*film, length, order, most_bytes)
                        : from_files(film->images, order, most_bytes);
}

std::string address(const Picture& picture) {
    return "data:image/png;base64," + base64(png(picture));
}

namespace {

/// Decodes the images of one target.
class Rows {
public:
    Rows(const check::Model& model, const check::Target& target, diag::Sink& sink)
        : model_(model), target_(target), sink_(sink) {}

    /// Returns nothing, after a report, if an image cannot be decoded.
    std::optional<std::vector<Picture>> pictures() {
        std::vector<Picture> rows(target_.rows);
        for (const check::EncodedRows& part : target_.encoded) {
            const auto decoded = decode(model_.encoded[part.encoded]);
            if (!decoded) return std::nullopt;
            std::copy_n(decoded->begin(), std::min<std::size_t>(part.count, decoded->size()),
                        rows.begin() + part.first);
        }
        return rows;
    }

private:
    std::optional<std::vector<Picture>> decode(const check::Encoded& of) {
        const std::string& spec = model_.file.path();
        const auto files = check::files_of(of, spec);
        if (!files) return fail(files.failure(), of.path);
        std::vector<std::string> paths;
        for (const std::string& file : *files) paths.push_back(data::beside(spec, file));
        return of.is_video ? frames_of(paths[0], of.frames) : images(paths);
    }

    std::optional<std::vector<Picture>> images(const std::vector<std::string>& paths) {
        const auto source = recordings::open_images(paths);
        if (!source) return fail(source.failure(), paths[0]);
        return all_of(**source, paths);
    }

    /// Returns the frames in the order of the spec.
    std::optional<std::vector<Picture>> frames_of(const std::string& path,
                                                  const std::vector<std::uint64_t>& frames) {
        std::vector<std::uint64_t> wanted = frames;
        std::sort(wanted.begin(), wanted.end());
        wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
        const auto source = recordings::open_video(path, {.only = wanted});
        if (!source) return fail(source.failure(), path);
        const auto decoded = all_of(**source, {path});
        if (!decoded) return std::nullopt;
        std::vector<Picture> rows;
        for (const std::uint64_t frame : frames) {
            const auto at = std::lower_bound(wanted.begin(), wanted.end(), frame);
            rows.push_back((*decoded)[static_cast<std::size_t>(at - wanted.begin())]);
        }
        return rows;
    }

    std::optional<std::vector<Picture>> all_of(recordings::FrameSource& source,
                                               const std::vector<std::string>& paths) {
        std::vector<Picture> decoded;
        recordings::Frame frame;
        for (;;) {
            const auto more = source.next(frame);
            if (!more)
                return fail(more.failure(), paths[std::min(decoded.size(), paths.size() - 1)]);
            if (!*more) return decoded;
            decoded.push_back(shrunk(frame.rgb, frame.width, frame.height, 3, kMostPixels));
        }
    }

    std::nullopt_t fail(const diag::Failure& failure, const std::string& path) {
        sink_.report(data::in_file({diag::Code::frames_left_out, failure.message}, path))
            .note(fmt::format("target '{}' is shown without pictures", target_.name));
        return std::nullopt;
    }

    const check::Model& model_;
    const check::Target& target_;
    diag::Sink& sink_;
};

}  // namespace

TargetPictures pictures_of_targets(const check::Model& model,
                                   const std::vector<check::Index>& predicates,
                                   std::uint64_t most_bytes, diag::Sink& sink) {
    TargetPictures found;
    for (const check::Index p : predicates) {
        const check::Index index = declared_target(model, model.predicates[p]);
        if (index == check::kNone || model.targets[index].encoded.empty()) continue;
        if (found.find(index) != found.end()) continue;
        const auto pictures = Rows(model, model.targets[index], sink).pictures();
        if (!pictures) continue;
        std::vector<std::string>& addresses = found[index];
        for (const Picture& picture : *pictures) {
            std::string text = picture.width > 0 ? address(picture) : "";
            if (text.size() > most_bytes) text.clear();
            most_bytes -= text.size();
            addresses.push_back(std::move(text));
        }
    }
    return found;
}

namespace {

constexpr std::size_t kMostFrames = 384;  ///< of a point, to find its plane
constexpr std::size_t kPlaneEpisodes = 24;

using fit::Matrix;
using fit::Vector;
using Frames = std::vector<std::vector<float>>;

bool only_angles(const check::Model& model, Index point) {
    return std::all_of(model.distances.begin(), model.distances.end(), [&](const auto& distance) {
        return distance.point != point || check::is_of_directions(distance.metric);
    });
}

double length(const float* z, std::size_t dimension) {
    double sum = 0;
    for (std::size_t i = 0; i < dimension; ++i) sum += static_cast<double>(z[i]) * z[i];
    return std::sqrt(sum);
}

Matrix columns(const Frames& frames, bool by_direction) {
    const auto dimension = static_cast<Eigen::Index>(frames.front().size());
    Matrix all(dimension, static_cast<Eigen::Index>(frames.size()));
    for (std::size_t k = 0; k < frames.size(); ++k) {
        const double norm = by_direction ? length(frames[k].data(), frames[k].size()) : 1;
        for (Eigen::Index i = 0; i < dimension; ++i)
            all(i, static_cast<Eigen::Index>(k)) =
                norm > 0 ? frames[k][static_cast<std::size_t>(i)] / norm : 0.0;
    }
    return all;
}

/// Computes the axes from the smaller of the two products of the frames with their transpose, which
/// have the same eigenvalues.
void take_axes(Matrix frames, Plane& plane) {
    const Vector mean = frames.rowwise().mean();
    frames.colwise() -= mean;
    plane.mean.assign(mean.data(), mean.data() + mean.size());
    const bool fewer_frames = frames.cols() < frames.rows();
    const Matrix products =
        fewer_frames ? Matrix(frames.transpose() * frames) : Matrix(frames * frames.transpose());
    const fit::Eigenpairs greatest = fit::greatest_eigenpairs(products, 2);
    const double all = products.trace();
    for (std::size_t k = 0; k < 2; ++k) {
        const auto at = static_cast<Eigen::Index>(k);
        Vector axis = fewer_frames ? Vector(frames * greatest.vectors.col(at))
                                   : Vector(greatest.vectors.col(at));
        if (axis.norm() > 0) axis.normalize();
        Eigen::Index largest = 0;
        axis.cwiseAbs().maxCoeff(&largest);
        if (axis[largest] < 0) axis = -axis;
        plane.axes[k].assign(axis.data(), axis.data() + axis.size());
        plane.explained[k] = all > 0 ? std::max(greatest.values[at], 0.0) / all : 0;
    }
}

/// A point of two numbers is its own plane.
void take_numbers(Plane& plane) {
    plane.mean = {0, 0};
    plane.axes = {std::vector<double>{1, 0}, {0, 1}};
}

/// Returns the points of several numbers from which the predicates measure.
std::vector<Index> points_to_draw(const check::Model& model, const std::vector<Index>& predicates) {
    std::set<Index> points;
    for (const Index p : predicates)
        for (const Index d : model.predicates[p].distances())
            if (model.point_of(d).dimension > 1) points.insert(model.distances[d].point);
    return {points.begin(), points.end()};
}

}  // namespace

std::array<float, 2> Plane::operator()(const float* z) const {
    const double norm = by_direction ? length(z, mean.size()) : 1;
    std::array<float, 2> at{};
    for (std::size_t k = 0; k < 2; ++k) {
        double sum = 0;
        for (std::size_t i = 0; i < mean.size(); ++i)
            sum += axes[k][i] * ((norm > 0 ? z[i] / norm : 0) - mean[i]);
        at[k] = static_cast<float>(sum);
    }
    return at;
}

diag::Result<std::vector<Plane>> planes(const check::Model& model,
                                        const std::vector<Index>& predicates,
                                        const std::vector<std::string>& paths,
                                        const episodes::ReadOptions& reading) {
    fit::fix_order_of_sums();
    const std::vector<Index> points = points_to_draw(model, predicates);
    const plan::Plan measuring = plan::measuring(model, predicates);
    const std::size_t read = std::min(paths.size(), kPlaneEpisodes);
    std::vector<Frames> frames(points.size());
    episodes::Follower follower(measuring);
    for (std::size_t i = 0; i < read && !points.empty(); ++i) {
        auto recording = episodes::Recording::open({&model, measuring.inputs},
                                                   paths[i * paths.size() / read], reading);
        if (!recording) return recording.failure();
        std::vector<fit::EvenFrames> of_points(points.size(), {kMostFrames / read, 0});
        std::uint64_t step = 0;
        const auto done = episodes::replay(*recording, {&follower}, [&] {
            for (std::size_t k = 0; k < points.size(); ++k)
                if (const float* z = follower.evaluator().point(points[k]))
                    of_points[k].add(step, {z, z + model.points[points[k]].dimension});
            ++step;
            return true;
        });
        if (!done) return done.failure();
        for (std::size_t k = 0; k < points.size(); ++k)
            for (fit::TakenFrame& taken : of_points[k].take())
                frames[k].push_back(std::move(taken.values));
    }
    std::vector<Plane> found;
    for (std::size_t k = 0; k < points.size(); ++k) {
        if (frames[k].size() < 2) continue;
        Plane plane;
        plane.point = points[k];
        plane.by_direction = model.points[points[k]].dimension > 2 && only_angles(model, points[k]);
        if (model.points[points[k]].dimension == 2)
            take_numbers(plane);
        else
            take_axes(columns(frames[k], plane.by_direction), plane);
        found.push_back(std::move(plane));
    }
    return found;
}

}  // namespace etlc::report
