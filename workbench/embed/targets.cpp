#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "artifacts/embedded.hpp"
#include "check/encoders/encoded.hpp"
#include "check/encoders/encoders.hpp"
#include "data/arrays/array.hpp"
#include "data/files/file.hpp"
#include "data/files/hash.hpp"
#include "embed/embed.hpp"
#include "recordings/frames/frames.hpp"

namespace etlc::embed {

namespace {

using check::Encoded;
using check::Index;
using diag::Code;

/// Encodes all that one encoder encodes: what the spec names, and the reference frames.
class Targets {
public:
    Targets(const check::Model& model, Index encoder, const Request& request, embedded::File& file,
            diag::Sink& sink)
        : model_(model),
          encoder_(model.encoders[encoder]),
          index_(encoder),
          request_(request),
          file_(file),
          sink_(sink) {}

    bool embed() {
        auto started = Encoder::start(encoder_, data::beside(model_.file.path(), encoder_.model),
                                      request_.running);
        if (!started) return fail(started.failure());
        Encoder* const running = started->get();
        for (const Encoded& encoded : model_.encoded)
            if (encoded.encoder == index_ && !add(*running, encoded)) return false;
        embedded::Encoder& made = file_.encoders[encoder_.name];
        std::vector<float> rows;
        const auto keep = [&](const std::vector<float>& row) {
            rows.insert(rows.end(), row.begin(), row.end());
        };
        for (std::uint32_t i = 0; i <= embedded::kReferenceFrames; ++i) {  // the first one twice
            const std::uint32_t frame = i % embedded::kReferenceFrames;
            if (const auto failure = running->add(recordings::reference_frame(frame),
                                                  fmt::format("reference frame {}", frame), keep))
                return fail(*failure);
        }
        if (const auto trouble = running->finish()) return fail(trouble->failure);
        made.dimension = running->dimension();
        const std::size_t again = rows.size() - made.dimension;
        if (const auto failure = in_two_ways(rows.data(), rows.data() + again, made.dimension))
            return fail(*failure);
        rows.resize(again);
        made.references = std::move(rows);
        return true;
    }

private:
    /// Compares the embeddings of a frame that was encoded twice.
    std::optional<diag::Failure> in_two_ways(const float* first, const float* again,
                                             std::size_t elements) const {
        const double difference = embedded::relative_difference(again, first, elements);
        if (difference <= embedded::kSameEncoder) return std::nullopt;
        return diag::Failure{
            Code::encoder_failed,
            fmt::format("'{}' gives another embedding of the same frame the second time, at a "
                        "distance of {:.2g} times its length, expected at most {:g}: probably "
                        "it is in training mode, where dropout draws random numbers; export it "
                        "after model.eval()",
                        encoder_.name, difference, embedded::kSameEncoder)};
    }

    bool add(Encoder& running, const Encoded& encoded) {
        const auto files = check::files_of(encoded, model_.file.path());
        if (!files) return fail(files.failure(), encoded.path, encoded);
        embedded::Entry& entry = file_.entries[encoded.text];
        entry.encoder = encoder_.name;
        std::vector<std::string> paths;
        const Code code = encoded.is_video ? Code::unreadable_video : Code::unreadable_image;
        for (const std::string& path : *files) {
            paths.push_back(data::beside(model_.file.path(), path));
            const auto hash = data::hash_of_file(paths.back(), code);
            if (!hash) return fail(hash.failure(), paths.back(), encoded);
            entry.sources.push_back({path, *hash});
        }
        std::set<std::uint64_t> wanted(encoded.frames.begin(), encoded.frames.end());
        auto frames = encoded.is_video ? recordings::open_video(
                                             paths[0], {.only = {wanted.begin(), wanted.end()}})
                                       : recordings::open_images(paths);
        if (!frames) return fail(frames.failure(), paths[0], encoded);
        const auto done = [&entry, &encoded, wanted](const std::vector<float>& rows) {
            fill(entry, encoded, {wanted.begin(), wanted.end()}, rows);
        };
        const auto trouble = running.add(**frames, encoded.path, done);
        if (!trouble) return true;
        if (trouble->of_encoder) return fail(trouble->failure);
        const auto last = paths.size() - 1;
        return fail(trouble->failure, paths[std::min<std::size_t>(trouble->frame, last)], encoded);
    }

    /// Makes a row for each image, or for each frame in the order of the spec.
    static void fill(embedded::Entry& entry, const Encoded& encoded,
                     const std::vector<std::uint64_t>& decoded, const std::vector<float>& rows) {
        const std::size_t count = encoded.is_video ? decoded.size() : entry.sources.size();
        const std::size_t width = rows.size() / count;
        entry.columns = static_cast<std::uint32_t>(width);
        if (!encoded.is_video) entry.matrix = rows;
        for (const std::uint64_t frame : encoded.frames) {
            const auto at = std::lower_bound(decoded.begin(), decoded.end(), frame);
            const auto first = rows.begin() + (at - decoded.begin()) * static_cast<long>(width);
            entry.matrix.insert(entry.matrix.end(), first, first + static_cast<long>(width));
        }
        entry.rows = static_cast<std::uint32_t>(entry.matrix.size() / width);
        entry.hash = data::content_hash({entry.rows, entry.columns}, entry.matrix);
    }

    bool fail(const diag::Failure& failure, const std::string& path, const Encoded& encoded) {
        sink_.report(data::in_file(failure, path))
            .note(encoded.span, "a target is made of it here");
        return false;
    }

    bool fail(const diag::Failure& failure) {
        sink_.report(of_encoder(failure, model_, encoder_));
        return false;
    }

    const check::Model& model_;
    const check::Encoder& encoder_;
    Index index_;
    const Request& request_;
    embedded::File& file_;
    diag::Sink& sink_;
};

}  // namespace

std::optional<embedded::File> describe_encoders(check::Model& model, Request& request,
                                                diag::Sink& sink) {
    embedded::File file;
    file.spec = model.name;
    file.etlc = request.version;
    for (check::Encoder& encoder : model.encoders) {
        std::string place;
        auto described = check::describe(encoder, model.file.path(), place);
        if (!described) {
            sink.report(of_encoder(described.failure(), model, encoder)).file = place;
            continue;
        }
        if (request.running.kind.empty())
            if (const auto failure = settle(request.running)) {
                sink.report(of_encoder(*failure, model, encoder));
                return std::nullopt;
            }
        described->kind = request.running.kind;
        described->dimension = encoder.dimension;
        encoder.fingerprint = embedded::fingerprint(*described);
        file.encoders[encoder.name] = std::move(*described);
    }
    if (sink.has_errors()) return std::nullopt;
    return file;
}

bool embed_targets(const check::Model& model, const Request& request, embedded::File& file,
                   diag::Sink& sink) {
    for (Index encoder = 0; encoder < model.encoders.size(); ++encoder)
        if (!Targets(model, encoder, request, file, sink).embed()) return false;
    return true;
}

}  // namespace etlc::embed
