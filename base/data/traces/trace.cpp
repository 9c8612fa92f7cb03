#include "data/traces/trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "data/arrays/array.hpp"
#include "data/files/file.hpp"
#include "data/spill/spill.hpp"
#include "data/text/text.hpp"
#include "data/traces/trace_formats.hpp"

namespace etlc::data {

namespace {

/// Finds the colon of "runs.h5:data/demo_0", unless that is the name of a file.
std::size_t group_mark(const std::string& path) {
    std::error_code error;
    if (std::filesystem::exists(path, error)) return std::string::npos;
    for (std::size_t at = path.find(':'); at != std::string::npos; at = path.find(':', at + 1))
        if (is_hdf5(path.substr(0, at))) return at;
    return std::string::npos;
}

}  // namespace

bool is_hdf5(const std::string& path) {
    return path.ends_with(".h5") || path.ends_with(".hdf5");
}

bool is_dataset(const std::string& folder) {
    std::error_code error;
    return std::filesystem::exists(folder + "/meta/info.json", error);
}

std::optional<DatasetPath> dataset_path(const std::string& path) {
    std::error_code error;
    if (is_dataset(path)) {
        const std::size_t end = path.find_last_not_of('/');
        return DatasetPath{end == std::string::npos ? path : path.substr(0, end + 1)};
    }
    if (std::filesystem::exists(path, error)) return std::nullopt;
    std::vector<std::uint64_t> numbers;
    std::string folder = path;
    while (numbers.size() < 2 && !is_dataset(folder)) {
        const std::size_t colon = folder.rfind(':');
        if (colon == std::string::npos) return std::nullopt;
        const auto number = parse_whole<std::uint64_t>(std::string_view(folder).substr(colon + 1));
        if (!number) return std::nullopt;
        numbers.push_back(*number);
        folder.resize(colon);
    }
    if (!is_dataset(folder)) return std::nullopt;
    if (numbers.size() == 1) return DatasetPath{folder, numbers[0], numbers[0] + 1};
    return DatasetPath{folder, numbers[1], numbers[0]};
}

std::string trace_file(const std::string& path) {
    if (const auto set = dataset_path(path)) return set->folder;
    return path.substr(0, group_mark(path));
}

namespace {

using diag::Code;
using diag::Failure;

constexpr std::size_t kBlockBytes = 1U << 16U;
constexpr std::size_t kFortranBlockBytes =
    8U << 20U;  ///< large, since every column of a block takes a seek

std::uint64_t rows_in(std::size_t bytes, std::uint64_t row_bytes, std::uint64_t rows) {
    return std::min(rows,
                    std::max<std::uint64_t>(1, bytes / std::max<std::uint64_t>(1, row_bytes)));
}

Failure unsound_boolean(char byte, std::uint64_t row) {
    return {Code::malformed_array,
            fmt::format("has the byte {} as bool in step {}, expected 0 or 1",
                        static_cast<unsigned char>(byte), row)};
}

class StraightRows final : public Rows {
public:
    StraightRows(std::unique_ptr<ByteSource> source, NpyHeader header, std::uint64_t rows,
                 std::uint32_t width)
        : source_(std::move(source)), header_(std::move(header)), rows_(rows), width_(width) {
        const std::uint64_t row_bytes = std::uint64_t{width} * info(header_.element).bytes;
        block_rows_ = rows_in(kBlockBytes, row_bytes, rows);
        bytes_.resize(block_rows_ * row_bytes);
        values_.resize(block_rows_ * width);
    }

    diag::Result<const double*> next() override {
        const std::uint64_t in_block = done_ % block_rows_;
        if (in_block == 0)
            if (auto failure = fill()) return *failure;
        ++done_;
        return values_.data() + in_block * width_;
    }

private:
    std::optional<Failure> fill() {
        const std::uint64_t n = std::min(block_rows_, rows_ - done_);
        const std::size_t element_bytes = info(header_.element).bytes;
        const std::size_t wanted = n * width_ * element_bytes;
        const auto got = source_->read(bytes_.data(), wanted);
        if (!got) return got.failure();
        if (*got < wanted)
            return check_size(header_,
                              header_.header_bytes + done_ * width_ * element_bytes + *got);
        const std::size_t sound =
            decode(header_.element, bytes_.data(), n * width_, values_.data());
        if (sound < n * width_) return unsound_boolean(bytes_[sound], done_ + sound / width_);
        if (done_ + n < rows_) return {};
        // An archive compares its checksum at the end.
        const auto more = source_->read(bytes_.data(), 1);
        if (!more) return more.failure();
        return check_size(header_, header_.header_bytes + header_.data_bytes() + *more);
    }

    std::unique_ptr<ByteSource> source_;
    NpyHeader header_;
    std::uint64_t rows_;
    std::uint32_t width_;
    std::uint64_t block_rows_ = 1;
    std::uint64_t done_ = 0;
    std::vector<char> bytes_;
    std::vector<double> values_;
};

/// Returns what `work` returns, or a Failure where its temporary file fails.
template <class Work>
auto in_temporary_file(const Work& work) -> decltype(work()) {
    try {
        return work();
    } catch (const SpillError& error) {
        return Failure{
            Code::unreadable_data_file,
            fmt::format("is in Fortran order, and {}; in C order it needs none", error.what())};
    }
}

class FortranRows final : public Rows {
public:
    static diag::Result<std::unique_ptr<Rows>> open(ByteSource& source, NpyHeader header,
                                                    std::uint64_t rows, std::uint32_t width) {
        SpillFile file;
        if (auto failure = in_temporary_file([&] { return unpack(source, header, file); }))
            return *failure;
        return std::unique_ptr<Rows>(
            new FortranRows(std::move(file), std::move(header), rows, width));
    }

    diag::Result<const double*> next() override {
        const std::uint64_t in_block = done_ % block_rows_;
        if (in_block == 0)
            if (auto failure = in_temporary_file([&] { return fill(); })) return *failure;
        for (std::uint32_t d = 0; d < width_; ++d) row_[d] = columns_[d * block_rows_ + in_block];
        ++done_;
        return row_.data();
    }

private:
    FortranRows(SpillFile file, NpyHeader header, std::uint64_t rows, std::uint32_t width)
        : file_(std::move(file)),
          header_(std::move(header)),
          rows_(rows),
          width_(width),
          row_(width) {
        element_bytes_ = info(header_.element).bytes;
        block_rows_ = rows_in(kFortranBlockBytes, std::uint64_t{width} * sizeof(double), rows);
        bytes_.resize(block_rows_ * element_bytes_);
        columns_.resize(block_rows_ * width);
    }

    static std::optional<Failure> unpack(ByteSource& source, const NpyHeader& header,
                                         SpillFile& file) {
        std::vector<char> buffer(kBlockBytes);
        std::uint64_t total = header.header_bytes;
        for (;;) {
            const auto got = source.read(buffer.data(), buffer.size());
            if (!got) return got.failure();
            total += *got;
            if (total > header.header_bytes + header.data_bytes())
                break;  // more than promised: not to be stored
            file.append({buffer.data(), *got});
            if (*got < buffer.size()) break;
        }
        return check_size(header, total);
    }

    std::optional<Failure> fill() {
        const std::uint64_t n = std::min(block_rows_, rows_ - done_);
        for (std::uint32_t d = 0; d < width_; ++d) {
            const std::uint64_t at = (d * rows_ + done_) * element_bytes_;
            file_.read(at, bytes_.data(), n * element_bytes_);
            const std::size_t sound =
                decode(header_.element, bytes_.data(), n, columns_.data() + d * block_rows_);
            if (sound < n) return unsound_boolean(bytes_[sound], done_ + sound);
        }
        return {};
    }

    SpillFile file_;
    NpyHeader header_;
    std::uint64_t rows_;
    std::uint32_t width_;
    std::size_t element_bytes_ = 1;
    std::uint64_t block_rows_ = 1;
    std::uint64_t done_ = 0;
    std::vector<char> bytes_;
    std::vector<double> columns_;  ///< width x block_rows_
    std::vector<double> row_;
};

}  // namespace

diag::Result<std::unique_ptr<Rows>> open_rows(std::unique_ptr<ByteSource> source,
                                              const NpyHeader& header, std::uint64_t rows,
                                              std::uint32_t width) {
    if (auto failure = check_size(header, source->size())) return *failure;
    if (header.fortran_order && width > 1 && rows > 1)
        return FortranRows::open(*source, header, rows, width);
    return std::unique_ptr<Rows>(
        std::make_unique<StraightRows>(std::move(source), header, rows, width));
}

namespace {

using Kind = Channel::Kind;

/// Written without branches, so that it is vectorized: files have up to a billion elements. Adding
/// one to an exponent of all ones carries into the sign.
bool all_finite(const std::vector<double>& values) {
    constexpr std::uint64_t kExponent = 0x7ff0000000000000;
    constexpr std::uint64_t kOne = 0x0010000000000000;
    std::uint64_t found = 0;
    for (const double value : values)
        found |= (std::bit_cast<std::uint64_t>(value) & kExponent) + kOne;
    return found >> 63 == 0;
}

class ArrayTrace final : public Trace {
public:
    ArrayTrace(std::vector<Feed> feeds, std::uint64_t length)
        : feeds_(std::move(feeds)), length_(length) {}

    std::uint64_t length() const override { return length_; }
    bool has(std::size_t channel) const override { return feeds_[channel].rows != nullptr; }

    diag::Result<bool> next(Sample& sample) override {
        if (step_ == length_) return false;
        sample.values.resize(feeds_.size());
        sample.present.assign(feeds_.size(), true);
        for (std::size_t c = 0; c < feeds_.size(); ++c) {
            if (!has(c)) {
                sample.present[c] = false;
                sample.values[c].assign(feeds_[c].channel.width,
                                        std::numeric_limits<double>::quiet_NaN());
                continue;
            }
            const auto row = feeds_[c].rows->next();
            if (!row) return of_trace(in_array(row.failure(), feeds_[c].channel.name));
            if (auto failure = copy(*row, feeds_[c].channel, sample.values[c])) return *failure;
        }
        ++step_;
        return true;
    }

private:
    std::optional<Failure> copy(const double* row, const Channel& channel,
                                std::vector<double>& values) const {
        values.assign(row, row + channel.width);
        const bool sound = channel.kind != Kind::boolean && all_finite(values);
        for (double& value : sound ? std::span<double>() : std::span(values)) {
            if (!std::isfinite(value)) {
                value = std::numeric_limits<double>::quiet_NaN();
            } else if (channel.kind == Kind::boolean && value != 0 && value != 1) {
                return Failure{Code::trace_elements,
                               fmt::format("array {}: holds {} in step {}, expected 0 or 1",
                                           in_quotes(channel.name), value, step_)};
            }
        }
        return {};
    }

    std::vector<Feed> feeds_;
    std::uint64_t length_;
    std::uint64_t step_ = 0;
};

}  // namespace

std::optional<Failure> check_array(const std::vector<std::uint64_t>& shape, bool has_bools,
                                   const Channel& channel) {
    if (has_bools && channel.kind != Kind::boolean)
        return in_array(
            {Code::trace_elements, "has bool elements, expected numbers: the input is no bool"},
            channel.name);
    const bool flat = shape.size() == 1 && channel.width == 1;
    const bool table = shape.size() == 2 && shape[1] == channel.width;
    if (flat || table) return {};
    const std::string expected = channel.kind == Kind::vector
                                     ? fmt::format("(steps, {})", channel.width)
                                     : "(steps,) or (steps, 1)";
    return in_array(
        {Code::trace_shape, fmt::format("has shape {}, expected {}", shape_text(shape), expected)},
        channel.name);
}

diag::Result<std::unique_ptr<Trace>> open_array_trace(std::vector<Feed> feeds) {
    const Feed* first = nullptr;  // of those that are there
    for (const Feed& feed : feeds) {
        if (feed.rows == nullptr) continue;
        if (first == nullptr) first = &feed;
        if (feed.steps != first->steps)
            return Failure{Code::trace_shape,
                           fmt::format("arrays differ in length: {} has {} steps, {} has {}",
                                       in_quotes(first->channel.name), first->steps,
                                       in_quotes(feed.channel.name), feed.steps)};
    }
    if (first == nullptr)
        return Failure{
            Code::trace_shape,
            "the spec reads no input, so the arrays do not tell how many steps there are"};
    const std::uint64_t length = first->steps;
    return std::unique_ptr<Trace>(std::make_unique<ArrayTrace>(std::move(feeds), length));
}

namespace {

Failure of_channel(const Failure& failure, const Channel& channel) {
    return of_trace(in_array(failure, channel.name));
}

diag::Result<Feed> open_feed(const std::string& path, const Channel& channel) {
    const auto archive = Archive::open(path);
    if (!archive) return of_trace(archive.failure());
    const auto& keys = archive->keys();
    if (channel.optional && std::find(keys.begin(), keys.end(), channel.name) == keys.end())
        return Feed{channel, 0, nullptr};
    auto member = archive->member(channel.name);
    if (!member) return of_trace(member.failure());
    auto header = read_npy_header(**member);
    if (!header && are_times(channel)) return Feed{channel, 0, nullptr};
    if (!header) return of_channel(header.failure(), channel);
    const bool has_bools = header->element == Element::boolean;
    if (auto failure = check_array(header->shape, has_bools, channel)) {
        if (are_times(channel)) return Feed{channel, 0, nullptr};
        return *failure;
    }
    auto rows = open_rows(std::move(*member), *header, header->shape[0], channel.width);
    if (!rows) return of_channel(rows.failure(), channel);
    return Feed{channel, header->shape[0], std::move(*rows)};
}

}  // namespace

diag::Failure of_trace(Failure failure) {
    switch (failure.code) {
        case Code::unreadable_data_file: failure.code = Code::unreadable_trace; break;
        case Code::unknown_data_format: failure.code = Code::unknown_trace_format; break;
        case Code::unsupported_elements: failure.code = Code::trace_elements; break;
        case Code::no_such_array: failure.code = Code::no_such_channel; break;
        case Code::malformed_array:
        case Code::wrong_array_size:
        case Code::array_too_large:
        case Code::malformed_archive: failure.code = Code::malformed_trace_array; break;
        default: break;
    }
    return failure;
}

diag::Result<std::unique_ptr<Trace>> open_npz_trace(const std::string& path,
                                                    const std::vector<Channel>& channels) {
    std::vector<Feed> feeds;
    for (const Channel& channel : channels) {
        auto feed = open_feed(path, channel);
        if (!feed) return feed.failure();
        if (are_times(channel) && (feeds.empty() || feed->steps != feeds.front().steps))
            feed->rows = nullptr;
        feeds.push_back(std::move(*feed));
    }
    return open_array_trace(std::move(feeds));
}

}  // namespace etlc::data
