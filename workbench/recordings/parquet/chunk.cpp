#include <snappy.h>
#include <zlib.h>
#include <zstd.h>
#include <algorithm>
#include <bit>
#include <limits>

#include "recordings/parquet/chunk.hpp"
#include "recordings/parquet/footer.hpp"

namespace etlc::recordings::parquet {

namespace {

constexpr std::uint64_t kMaxPageBytes = 256U << 20U;

enum Codec : std::int64_t { kUncompressed = 0, kSnappy = 1, kZstd = 6 };

[[noreturn]] void damaged() {
    refuse("is damaged: a page of it cannot be unpacked");
}

void check_size(std::uint64_t found, std::uint64_t claimed) {
    if (found != claimed)
        refuse("has a page that claims " + std::to_string(claimed) + " bytes and unpacks to " +
               std::to_string(found));
}

/// Throws Refused where the codec is not supported.
void check_codec(std::int64_t codec) {
    if (codec == kUncompressed || codec == kSnappy || codec == kZstd) return;
    static const char* const kNames[] = {"", "", "GZIP", "LZO", "BROTLI", "LZ4", "", "LZ4_RAW"};
    const bool known = codec >= 0 && codec < 8;
    refuse("is packed by " +
           (known ? std::string(kNames[codec]) : "the codec " + std::to_string(codec)) +
           ", expected UNCOMPRESSED, SNAPPY or ZSTD");
}

/// Decompresses a page. Throws Refused where it is damaged, or does not have `size` bytes. The size
/// that a page claims is compared with the compressed data before memory is allocated for it.
std::string unpacked(std::int64_t codec, std::string_view packed, std::uint64_t size) {
    if (size > kMaxPageBytes)
        refuse("has a page that claims " + std::to_string(size) + " bytes, at most " +
               std::to_string(kMaxPageBytes) + " are read");
    std::string bytes;
    if (size == 0 && packed.empty()) return bytes;  // of nulls only, whatever the codec
    if (codec == kSnappy) {
        std::size_t found = 0;
        if (!snappy::GetUncompressedLength(packed.data(), packed.size(), &found)) damaged();
        check_size(found, size);
        bytes.resize(size);
        if (!snappy::RawUncompress(packed.data(), packed.size(), bytes.data())) damaged();
        return bytes;
    }
    if (codec == kZstd) {
        bytes.resize(size);
        const std::size_t found =
            ZSTD_decompress(bytes.data(), bytes.size(), packed.data(), packed.size());
        if (ZSTD_isError(found) != 0) damaged();
        check_size(found, size);
        return bytes;
    }
    check_size(packed.size(), size);
    return std::string(packed);
}

enum PageType : std::int64_t { kData = 0, kIndex = 1, kDictionary = 2, kDataV2 = 3 };
enum Encoding : std::int64_t {
    kPlain = 0,
    kPlainDictionary = 2,
    kRle = 3,
    kBitPacked = 4,
    kRleDictionary = 8
};

[[noreturn]] void refuse_encoding(std::int64_t encoding) {
    static const char* const kNames[] = {"PLAIN",
                                         "",
                                         "PLAIN_DICTIONARY",
                                         "RLE",
                                         "BIT_PACKED",
                                         "DELTA_BINARY_PACKED",
                                         "DELTA_LENGTH_BYTE_ARRAY",
                                         "DELTA_BYTE_ARRAY",
                                         "RLE_DICTIONARY",
                                         "BYTE_STREAM_SPLIT"};
    const bool known = encoding >= 0 && encoding < 10 && encoding != 1;
    refuse("is encoded as " +
           (known ? std::string(kNames[encoding]) : "the number " + std::to_string(encoding)) +
           ", expected PLAIN, RLE or a dictionary");
}

unsigned bits_of(std::uint8_t most) {
    return static_cast<unsigned>(std::bit_width(static_cast<unsigned>(most)));
}

}  // namespace

struct ChunkReader::PageHead {
    std::int64_t type = -1;
    std::int64_t unpacked = -1;
    std::int64_t packed = -1;
    std::optional<std::int64_t> checksum;
    std::int64_t values = -1;
    std::int64_t encoding = -1;
    std::int64_t level_encoding = kRle;  ///< an encoding other than RLE, where a level has one
    std::int64_t definition_bytes = 0;   ///< in pages of version 2
    std::int64_t repetition_bytes = 0;
    bool is_packed = true;
};

ChunkReader::ChunkReader(std::string_view file, const Column& column, const Chunk& chunk)
    : column_(column), codec_(chunk.codec), left_(chunk.values) {
    if (!chunk.why_not.empty()) refuse(chunk.why_not);
    check_codec(chunk.codec);
    bytes_ = file.substr(chunk.begin, chunk.bytes);
}

ChunkReader::PageHead ChunkReader::read_head() {
    PageHead head;
    Thrift thrift(bytes_);
    const auto whole = [&](std::int64_t& to, Type type) {
        to = thrift.whole(type);
        return true;
    };
    const auto level = [&](Type type) {
        const std::int64_t found = thrift.whole(type);
        if (found != kRle) head.level_encoding = found;
        return true;
    };
    thrift.structure([&](std::int64_t id, Type type) {
        if (id == 1) return whole(head.type, type);
        if (id == 2) return whole(head.unpacked, type);
        if (id == 3) return whole(head.packed, type);
        if (id == 4) {
            head.checksum = thrift.whole(type);
            return true;
        }
        if (type != Type::structure || (id != 5 && id != 7 && id != 8)) return false;
        thrift.structure([&](std::int64_t part, Type of) {
            if (part == 1) return whole(head.values, of);
            if (part == (id == 8 ? 4 : 2)) return whole(head.encoding, of);
            if (id == 5 && part == 3 && column_.most_defined > 0) return level(of);
            if (id == 5 && part == 4 && column_.is_list) return level(of);
            if (id == 8 && part == 5) return whole(head.definition_bytes, of);
            if (id == 8 && part == 6) return whole(head.repetition_bytes, of);
            if (id == 8 && part == 7) {
                head.is_packed = thrift.truth(of);
                return true;
            }
            return false;
        });
        return true;
    });
    bytes_ = thrift.rest();
    return head;
}

bool ChunkReader::load_page() {
    while (left_ > 0) {
        if (bytes_.empty()) refuse("ends " + std::to_string(left_) + " values before it should");
        PageHead head = read_head();
        if (head.packed < 0 || head.unpacked < 0 ||
            static_cast<std::uint64_t>(head.packed) > bytes_.size())
            refuse("has a page of " + std::to_string(head.packed) + " bytes, " +
                   std::to_string(bytes_.size()) + " are there: it is cut or damaged");
        const std::string_view packed = bytes_.substr(0, static_cast<std::size_t>(head.packed));
        bytes_.remove_prefix(packed.size());
        if (head.checksum && static_cast<std::uint32_t>(*head.checksum) !=
                                 ::crc32(0, reinterpret_cast<const Bytef*>(packed.data()),
                                         static_cast<uInt>(packed.size())))
            refuse("is damaged: the checksum of a page does not match its bytes");
        if (head.type == kIndex) continue;
        if (head.values < 0) refuse("has a page without a number of values");
        if (head.type == kDictionary) {
            load_dictionary(head, packed);
            continue;
        }
        if (head.type != kData && head.type != kDataV2)
            refuse("has a page of the type " + std::to_string(head.type) +
                   ", which Parquet does not have");
        if (static_cast<std::uint64_t>(head.values) > left_)
            refuse("has a page of " + std::to_string(head.values) + " values, at most " +
                   std::to_string(left_) + " are to come");
        load_data(head, packed);
        left_ -= in_page_;
        if (in_page_ > 0) return true;
    }
    return false;
}

void ChunkReader::load_dictionary(const PageHead& head, std::string_view packed) {
    if (has_dictionary_) refuse("has a second dictionary");
    if (head.encoding != kPlain && head.encoding != kPlainDictionary)
        refuse_encoding(head.encoding);
    const std::string bytes = unpacked(codec_, packed, static_cast<std::uint64_t>(head.unpacked));
    Cursor from(bytes);
    has_dictionary_ = true;
    double number = 0;
    std::string text;
    for (std::int64_t i = 0; i < head.values; ++i) {
        if (from.at_end()) refuse("has a dictionary that is cut");
        plain(from, number, text);
        if (column_.is_text())
            text_dictionary_.push_back(text);
        else
            number_dictionary_.push_back(number);
    }
}

void ChunkReader::load_data(const PageHead& head, std::string_view packed) {
    if (head.level_encoding != kRle) refuse_encoding(head.level_encoding);
    page_ = std::string();  // two pages of images are much
    const unsigned repetition_bits = column_.is_list ? 1 : 0;
    const unsigned definition_bits = bits_of(column_.most_defined);
    const auto size = static_cast<std::uint64_t>(head.unpacked);
    std::string_view repetitions, definitions, values;
    if (head.type == kDataV2) {
        const auto levels = static_cast<std::uint64_t>(head.repetition_bytes) +
                            static_cast<std::uint64_t>(head.definition_bytes);
        if (head.repetition_bytes < 0 || head.definition_bytes < 0 || levels > packed.size() ||
            levels > size)
            refuse("has a page with more bytes of levels than it has bytes");
        page_ = unpacked(head.is_packed ? codec_ : 0, packed.substr(levels), size - levels);
        repetitions = packed.substr(0, static_cast<std::size_t>(head.repetition_bytes));
        definitions =
            packed.substr(repetitions.size(), static_cast<std::size_t>(head.definition_bytes));
        values = page_;
    } else {
        page_ = unpacked(codec_, packed, size);
        Cursor from(page_);
        if (repetition_bits > 0)
            repetitions = from.take(from.number<std::uint32_t>("a page"), "the levels of a page");
        if (definition_bits > 0)
            definitions = from.take(from.number<std::uint32_t>("a page"), "the levels of a page");
        values = from.rest();
    }
    in_page_ = static_cast<std::uint64_t>(head.values);
    repetitions_ = Runs(repetitions, repetition_bits, "the levels of a page");
    definitions_ = Runs(definitions, definition_bits, "the levels of a page");
    begin_values(head.encoding, values);
}

void ChunkReader::begin_values(std::int64_t encoding, std::string_view bytes) {
    plain_ = Cursor(bytes);
    bools_left_ = 0;
    places_.reset();
    if (encoding == kPlain) {
        values_ = Values::plain;
    } else if (encoding == kPlainDictionary || encoding == kRleDictionary) {
        values_ = Values::places;
    } else if (encoding == kRle && column_.physical == Physical::boolean) {
        values_ = Values::runs_of_bools;
    } else {
        refuse_encoding(encoding);
    }
}

bool ChunkReader::fetch() {
    if (has_entry_) return true;
    if (in_page_ == 0 && !load_page()) return false;
    --in_page_;
    repetition_ = column_.is_list ? repetitions_.next() : 0;
    definition_ = column_.most_defined > 0 ? definitions_.next() : 0;
    if (definition_ > column_.most_defined)
        refuse("has a level of " + std::to_string(definition_) + ", at most " +
               std::to_string(column_.most_defined) + " is expected");
    has_entry_ = true;
    return true;
}

bool ChunkReader::next(Cell& cell) {
    cell.is_null = false;
    cell.numbers.clear();
    cell.texts.clear();
    return read(&cell);
}

void ChunkReader::end_row() {
    while (fetch() && repetition_ != 0) {
        has_entry_ = false;
        if (definition_ == column_.most_defined) add_value(nullptr);
    }
}

bool ChunkReader::is_at_row() const {
    if (has_entry_) return repetition_ == 0;
    return !column_.is_list || Runs(repetitions_).next() == 0;
}

std::uint64_t ChunkReader::rows_left() const {
    return (has_entry_ ? 1 : 0) + (column_.is_list ? Runs(repetitions_).zeros(in_page_) : in_page_);
}

void ChunkReader::skip(std::uint64_t rows) {
    bool may_go_on = false;  // the last row of the page before
    while (rows > 0) {
        if (!has_entry_ && in_page_ == 0 && !load_page())
            refuse("has fewer rows than its row group");
        if (!is_at_row()) {
            if (!may_go_on) refuse("has a row that begins in the middle of a list");
            may_go_on = false;
            end_row();
            continue;
        }
        may_go_on = rows_left() <= rows;
        if (!may_go_on) {
            for (; rows > 0; --rows) read(nullptr);
            return;
        }
        rows -= rows_left();
        in_page_ = 0;
        has_entry_ = false;
    }
    if (may_go_on) end_row();
}

bool ChunkReader::read(Cell* cell) {
    if (!fetch()) return false;
    if (repetition_ != 0) refuse("has a row that begins in the middle of a list");
    for (;;) {
        has_entry_ = false;
        const bool exists = definition_ == column_.most_defined;
        if (exists) {
            add_value(cell);
        } else if (column_.is_list && definition_ >= column_.element_level) {
            if (cell != nullptr && column_.is_text()) cell->texts.emplace_back();
            if (cell != nullptr && !column_.is_text())
                cell->numbers.push_back(std::numeric_limits<double>::quiet_NaN());
        } else if (cell != nullptr) {
            cell->is_null = !column_.is_list || definition_ < column_.null_list_level;
        }
        if (!column_.is_list || !fetch() || repetition_ == 0) return true;
        if (cell != nullptr && cell->count(column_) >= kMaxElements)
            refuse("has a list of more than " + std::to_string(kMaxElements) + " elements");
    }
}

void ChunkReader::add_value(Cell* cell) {
    double number = 0;
    std::string text;
    std::size_t place = 0;
    switch (values_) {
        case Values::plain: plain(plain_, number, text); break;
        case Values::runs_of_bools:
            if (!places_) {
                const auto size = plain_.number<std::uint32_t>("a page");
                places_.emplace(plain_.take(size, "a page"), 1U, "a page");
            }
            number = places_->next();
            break;
        case Values::places:
            if (!has_dictionary_) refuse("has places in a dictionary, and no dictionary");
            if (!places_) {
                const unsigned bits = plain_.byte("a page");
                if (bits > 32) refuse("has places of " + std::to_string(bits) + " bits");
                places_.emplace(plain_.rest(), bits, "a page");
            }
            place = places_->next();
            if (place >= std::max(number_dictionary_.size(), text_dictionary_.size()))
                refuse(
                    "has place " + std::to_string(place) + " in a dictionary of " +
                    std::to_string(std::max(number_dictionary_.size(), text_dictionary_.size())));
            if (cell == nullptr) return;
            if (column_.is_text())
                cell->texts.push_back(text_dictionary_[place]);
            else
                cell->numbers.push_back(number_dictionary_[place]);
            return;
    }
    if (cell == nullptr) return;
    if (column_.is_text())
        cell->texts.push_back(std::move(text));
    else
        cell->numbers.push_back(number);
}

double ChunkReader::plain_number(Cursor& from) const {
    constexpr const char* kWhat = "the values of a page";
    switch (column_.physical) {
        case Physical::int32:
            if (column_.is_unsigned) return from.number<std::uint32_t>(kWhat);
            return from.number<std::int32_t>(kWhat);
        case Physical::int64:
            if (column_.is_unsigned) return static_cast<double>(from.number<std::uint64_t>(kWhat));
            return static_cast<double>(from.number<std::int64_t>(kWhat));
        case Physical::float32: return from.number<float>(kWhat);
        default: return from.number<double>(kWhat);
    }
}

void ChunkReader::plain(Cursor& from, double& number, std::string& text) {
    if (column_.physical == Physical::binary) {
        const auto size = from.number<std::uint32_t>("the values of a page");
        if (size > kMaxTextBytes)
            refuse("has a value of " + std::to_string(size) + " bytes, at most " +
                   std::to_string(kMaxTextBytes) + " are read");
        text = from.take(size, "the values of a page");
    } else if (column_.physical == Physical::boolean) {
        if (bools_left_ == 0) {
            bool_bits_ = from.byte("the values of a page");
            bools_left_ = 8;
        }
        number = (bool_bits_ >> (8 - bools_left_)) & 1U;
        --bools_left_;
    } else {
        number = plain_number(from);
    }
}

}  // namespace etlc::recordings::parquet
