#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "check/encoders/encoded.hpp"
#include "data/files/file.hpp"
#include "recordings/frames/frames.hpp"
#include "report/document.hpp"
#include "report/pictures.hpp"

namespace etlc::report {

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

}  // namespace etlc::report
