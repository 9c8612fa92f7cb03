#include "data/arrays/rows.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>

#include "data/arrays/elements.hpp"
#include "data/files/descriptor.hpp"

namespace etlc::data {
namespace {

using diag::Code;
using diag::Failure;

constexpr std::size_t kBlockBytes = 1U << 16U;
constexpr std::size_t kFortranBlockBytes = 8U
                                           << 20U;  ///< larger: every column of a block is a seek

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
        // Reading on to the end lets the archive compare its checksum.
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

/// A file without a name, whose bytes are gone as soon as nobody reads them any more.
Descriptor nameless_file() {
    const char* const named = std::getenv("TMPDIR");
    const std::string folder = named != nullptr && *named != '\0' ? named : "/tmp";
    Descriptor file(::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600));
    if (file) return file;
    std::string path =
        folder + "/etlc.XXXXXX";  // on file systems where every file begins with a name
    file = Descriptor(::mkostemp(path.data(), O_CLOEXEC));
    if (file) ::unlink(path.c_str());
    return file;
}

Failure temporary_failed(int error) {
    return {Code::unreadable_data_file,
            fmt::format("a Fortran-ordered array needs a temporary file: {}; save it in C order, "
                        "or set TMPDIR to a folder with room for it",
                        std::strerror(error))};
}

class FortranRows final : public Rows {
public:
    static diag::Result<std::unique_ptr<Rows>> open(ByteSource& source, NpyHeader header,
                                                    std::uint64_t rows, std::uint32_t width) {
        Descriptor file = nameless_file();
        if (!file) return temporary_failed(errno);
        if (auto failure = unpack(source, header, file)) return *failure;
        return std::unique_ptr<Rows>(
            new FortranRows(std::move(file), std::move(header), rows, width));
    }

    diag::Result<const double*> next() override {
        const std::uint64_t in_block = done_ % block_rows_;
        if (in_block == 0)
            if (auto failure = fill()) return *failure;
        for (std::uint32_t d = 0; d < width_; ++d) row_[d] = columns_[d * block_rows_ + in_block];
        ++done_;
        return row_.data();
    }

private:
    FortranRows(Descriptor file, NpyHeader header, std::uint64_t rows, std::uint32_t width)
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
                                         const Descriptor& file) {
        std::vector<char> buffer(kBlockBytes);
        std::uint64_t total = header.header_bytes;
        for (;;) {
            const auto got = source.read(buffer.data(), buffer.size());
            if (!got) return got.failure();
            total += *got;
            if (total > header.header_bytes + header.data_bytes())
                break;  // more than promised: not to be stored
            if (!write_all(*file, {buffer.data(), *got})) return temporary_failed(errno);
            if (*got < buffer.size()) break;
        }
        return check_size(header, total);
    }

    std::optional<Failure> fill() {
        const std::uint64_t n = std::min(block_rows_, rows_ - done_);
        for (std::uint32_t d = 0; d < width_; ++d) {
            const std::uint64_t at = (d * rows_ + done_) * element_bytes_;
            if (!read_all_at(*file_, at, bytes_.data(), n * element_bytes_))
                return temporary_failed(errno);
            const std::size_t sound =
                decode(header_.element, bytes_.data(), n, columns_.data() + d * block_rows_);
            if (sound < n) return unsound_boolean(bytes_[sound], done_ + sound);
        }
        return {};
    }

    Descriptor file_;
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

}  // namespace etlc::data
