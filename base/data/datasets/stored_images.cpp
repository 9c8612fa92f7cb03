#include "data/datasets/stored_images.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "data/parquet/table.hpp"
#include "data/text/quote.hpp"

namespace etlc::data {
namespace {

using diag::Code;
using diag::Failure;

class StoredImages final : public FrameSource {
public:
    StoredImages(std::unique_ptr<Table> table, std::unique_ptr<ImageDecoder> decoder,
                 const DatasetEpisode& episode, std::string camera, std::uint64_t stride)
        : table_(std::move(table)),
          decoder_(std::move(decoder)),
          rows_(episode.rows),
          camera_(std::move(camera)),
          length_(episode.length),
          stride_(stride) {}

    diag::Result<bool> next(Frame& frame) override {
        for (;;) {
            const auto more = table_->next(cells_);
            if (!more) return of_rows(more.failure());
            if (*more != (row_ < length_))
                return of_rows({Code::unreadable_dataset,
                                "has other rows than before: it has changed meanwhile"});
            if (!*more) return false;
            if (row_ % stride_ == 0) break;
            ++row_;
        }
        if (auto failure = decode(frame)) {
            failure->message =
                fmt::format("row {} of the episode: {}: {}", row_, camera_, failure->message);
            return of_rows(*failure);
        }
        ++row_;
        return true;
    }

private:
    std::optional<Failure> decode(Frame& frame) {
        const Table::Cell& image = cells_[0];
        const Table::Cell& path = cells_[1];
        if (!image.is_null && !image.texts[0].empty())
            return decoder_->decode(image.texts[0], frame);
        if (!path.is_null && !path.texts[0].empty())
            return Failure{Code::unreadable_image,
                           fmt::format("has no bytes and the path {}, which is not read: expected "
                                       "the image itself",
                                       in_quotes(path.texts[0]))};
        return Failure{
            Code::unreadable_image,
            fmt::format("is {}, expected an image", image.is_null ? "null" : "without bytes")};
    }

    Failure of_rows(Failure failure) const {
        failure.message = fmt::format("{}: {}", rows_, failure.message);
        return failure;
    }

    std::unique_ptr<Table> table_;
    std::unique_ptr<ImageDecoder> decoder_;
    std::string rows_;
    std::string camera_;
    std::uint64_t length_;
    std::uint64_t stride_;
    std::uint64_t row_ = 0;  ///< of the episode, the next
    std::vector<Table::Cell> cells_;
};

/// What is wrong with the columns of a camera.
std::optional<std::string> refused(const std::string& camera,
                                   const std::vector<Table::Column>& columns) {
    const Table::Column& bytes = columns[0];
    const Table::Column& path = columns[1];
    const std::string expected =
        fmt::format("expected {} as a struct of bytes and path", in_quotes(camera));
    if (!bytes.is_there)
        return fmt::format("has no column {}, {}", in_quotes(camera + ".bytes"), expected);
    if (!bytes.is_text || bytes.is_list)
        return fmt::format("column {} does not hold bytes, {}", in_quotes(camera + ".bytes"),
                           expected);
    if (path.is_there && (!path.is_text || path.is_list))
        return fmt::format("column {} does not hold text, {}", in_quotes(camera + ".path"),
                           expected);
    return std::nullopt;
}

}  // namespace

diag::Result<std::unique_ptr<FrameSource>> open_stored_images(const Dataset& set,
                                                              const DatasetEpisode& episode,
                                                              const std::string& camera,
                                                              std::uint64_t stride) {
    const auto of_rows = [&](Code code, const std::string& why) {
        return Failure{code, fmt::format("{}: {}", episode.rows, why)};
    };
    auto table = Table::open(set.path_of(episode.rows), {camera + ".bytes", camera + ".path"},
                             "episode_index", episode.index);
    if (!table) return of_rows(table.failure().code, table.failure().message);
    if (const auto why = refused(camera, (*table)->columns()))
        return of_rows(Code::unreadable_parquet, *why);
    auto decoder = ImageDecoder::start();
    if (!decoder) return decoder.failure();
    return std::unique_ptr<FrameSource>(std::make_unique<StoredImages>(
        std::move(*table), std::move(*decoder), episode, camera, stride));
}

}  // namespace etlc::data
