#include <algorithm>
#include <optional>
#include <utility>

#include "recordings/parquet/footer.hpp"

namespace etlc::recordings::parquet {

namespace {

constexpr std::string_view kEncrypted = "PARE";

struct Element {
    std::string name;
    std::optional<std::int64_t> physical;
    std::int64_t repetition = kRequired;
    std::int64_t children = 0;
    std::optional<std::int64_t> converted;
    std::int64_t logical = 0;  ///< number of the field of LogicalType; 0: none
    bool is_unsigned = false;
};

/// Reads the field of LogicalType that is set; for an integer, also its sign.
void read_logical(Thrift& thrift, Element& element) {
    constexpr std::int64_t kInteger = 10;
    thrift.structure([&](std::int64_t kind, Type type) {
        element.logical = kind;
        if (kind != kInteger || type != Type::structure) return false;
        thrift.structure([&](std::int64_t id, Type of) {
            if (id == 2) element.is_unsigned = !thrift.truth(of);
            return id == 2;
        });
        return true;
    });
}

Element read_element(Thrift& thrift) {
    Element element;
    thrift.structure([&](std::int64_t id, Type type) {
        switch (id) {
            case 1: element.physical = thrift.whole(type); return true;
            case 3: element.repetition = thrift.whole(type); return true;
            case 4: element.name = thrift.binary(type); return true;
            case 5: element.children = thrift.whole(type); return true;
            case 6: element.converted = thrift.whole(type); return true;
            case 10: read_logical(thrift, element); return true;
            default: return false;
        }
    });
    constexpr std::int64_t kFirstUnsigned = 11, kLastUnsigned = 14;
    const std::int64_t converted = element.converted.value_or(0);
    if (converted >= kFirstUnsigned && converted <= kLastUnsigned) element.is_unsigned = true;
    return element;
}

/// Names the logical type where it is neither a number nor text; else null.
const char* foreign(const Element& element) {
    switch (element.logical) {
        case 5: return "decimals";
        case 6: return "dates";
        case 7: return "times";
        case 8: return "times";
        case 14: return "identifiers";
        case 15: return "float16";
        default: break;
    }
    switch (element.converted.value_or(-1)) {
        case 5: return "decimals";
        case 6: return "dates";
        case 7:
        case 8:
        case 9:
        case 10:
        case 21: return "times";
        default: return nullptr;
    }
}

/// Returns whether a group is a list or a map, whose inner names belong to the format.
bool is_collection(const Element& element) {
    constexpr std::int64_t kMap = 1, kList = 3;                // of the converted types
    constexpr std::int64_t kLogicalMap = 2, kLogicalList = 3;  // of the logical ones
    const std::int64_t converted = element.converted.value_or(0);
    return (converted >= kMap && converted <= kList) || element.logical == kLogicalMap ||
           element.logical == kLogicalList;
}

/// Builds the columns from the tree of fields, which is stored root first.
class Fields {
public:
    explicit Fields(std::vector<Element> elements) : elements_(std::move(elements)) {}

    std::vector<Column> read(std::size_t& leaves) {
        if (elements_.empty() || elements_[0].physical) refuse("has no table of columns");
        at_ = 1;
        std::vector<Column> columns;
        for (std::int64_t i = 0; i < elements_[0].children; ++i) add_field(columns);
        if (at_ != elements_.size()) refuse("lists more fields than its table has");
        leaves = leaves_;
        return columns;
    }

private:
    const Element& next() {
        if (at_ >= elements_.size()) refuse("lists fewer fields than its table has");
        return elements_[at_++];
    }

    void add_field(std::vector<Column>& columns) {
        Column column;
        column.leaf = leaves_;
        const std::size_t begin = at_;
        column.name = elements_[std::min(at_, elements_.size() - 1)].name;
        std::size_t repeated = 0;
        walk(column, repeated, 0);
        if (leaves_ - column.leaf != 1)
            column.why_not = "has " + std::to_string(leaves_ - column.leaf) +
                             " fields nested in it, expected a number, a text or a list of them";
        else if (repeated > 1)
            column.why_not =
                "has lists nested in lists, expected a number, a text or a list of "
                "them";
        columns.push_back(column);
        if (elements_[begin].physical) return;
        if (!is_collection(elements_[begin]))
            add_fields_of(begin, 1, column, columns);
        else if (is_list_of_structs(begin))
            add_fields_of(begin, 3, column, columns);
    }

    /// A list of structs is three groups, whatever their names: LIST, repeated, struct.
    bool is_list_of_structs(std::size_t place) const {
        if (place + 2 >= at_) return false;
        const Element& repeated = elements_[place + 1];
        const Element& element = elements_[place + 2];
        return repeated.repetition == kRepeated && !repeated.physical && repeated.children == 1 &&
               !element.physical && !is_collection(element);
    }

    /// Adds a column for every field of the struct at the end of the `depth` groups at `place`.
    void add_fields_of(std::size_t place, std::size_t depth, const Column& whole,
                       std::vector<Column>& columns) {
        Column parent;
        std::size_t around = 0;
        for (std::size_t i = 0; i < depth; ++i) enter(parent, around, elements_[place + i]);
        const std::size_t end = std::exchange(at_, place + depth);
        leaves_ = whole.leaf;
        while (at_ < end) {
            const Element& element = elements_[at_];
            Column column = parent;
            column.leaf = leaves_;
            column.name = whole.name + "." + element.name;
            std::size_t repeated = around;
            walk(column, repeated, 1);
            if (!element.physical || repeated > (depth == 1 ? 0U : 1U))
                column.why_not = "has lists or fields nested in it, expected a number or a text";
            columns.push_back(std::move(column));
        }
    }

    static void enter(Column& column, std::size_t& repeated, const Element& element) {
        if (element.repetition == kRepeated) {
            column.null_list_level = column.most_defined;
            column.is_list = true;
            ++repeated;
        }
        if (element.repetition != kRequired) ++column.most_defined;
        if (element.repetition == kRepeated) column.element_level = column.most_defined;
    }

    /// Reads the current field and all below it.
    void walk(Column& column, std::size_t& repeated, int depth) {
        constexpr int kMostNested = 32;
        if (depth > kMostNested) refuse("nests its fields too deep");
        const Element& element = next();
        enter(column, repeated, element);
        if (!element.physical) {
            for (std::int64_t i = 0; i < element.children; ++i) walk(column, repeated, depth + 1);
            return;
        }
        ++leaves_;
        if (*element.physical < 0 || *element.physical > 7)
            refuse("has a column of the type " + std::to_string(*element.physical) +
                   ", which Parquet does not have");
        column.physical = static_cast<Physical>(*element.physical);
        column.is_unsigned = element.is_unsigned;
        if (const char* const what = foreign(element))
            column.why_not = std::string("holds ") + what + ", expected numbers, bools or text";
        else if (column.physical == Physical::int96)
            column.why_not = "holds times of 96 bits, expected numbers, bools or text";
        else if (column.physical == Physical::fixed)
            column.why_not = "holds bytes of a fixed length, expected numbers, bools or text";
    }

    std::vector<Element> elements_;
    std::size_t at_ = 0;
    std::size_t leaves_ = 0;
};

class FooterReader {
public:
    FooterReader(std::string_view bytes, std::uint64_t begin)
        : thrift_(bytes), data_bytes_(begin) {}

    Footer read() {
        std::vector<Element> elements;
        std::uint64_t promised = 0;
        bool has_rows = false;
        thrift_.structure([&](std::int64_t id, Type type) {
            switch (id) {
                case 2:
                    thrift_.list(type, [&](Type) { elements.push_back(read_element(thrift_)); });
                    return true;
                case 3:
                    promised = count(thrift_.whole(type), "rows");
                    has_rows = true;
                    return true;
                case 4:
                    thrift_.list(type, [&](Type) { footer_.groups.push_back(row_group()); });
                    return true;
                case 8: refuse("is encrypted, which is not read");
                default: return false;
            }
        });
        std::size_t leaves = 0;
        footer_.columns = Fields(std::move(elements)).read(leaves);
        for (const RowGroup& group : footer_.groups) {
            if (group.chunks.size() != leaves)
                refuse("has a row group of " + std::to_string(group.chunks.size()) +
                       " columns, expected " + std::to_string(leaves));
            footer_.rows += group.rows;
        }
        if (!has_rows || promised != footer_.rows)
            refuse("promises " + std::to_string(promised) + " rows, its row groups have " +
                   std::to_string(footer_.rows));
        if (footer_.rows > kMaxRows)
            refuse("claims " + std::to_string(footer_.rows) + " rows, at most " +
                   std::to_string(kMaxRows) + " are read");
        return std::move(footer_);
    }

private:
    static std::uint64_t count(std::int64_t n, const char* what) {
        constexpr std::int64_t kMost = 1LL << 48U;
        if (n < 0 || n > kMost)
            refuse("claims " + std::to_string(n) + " " + what + ", which no file holds");
        return static_cast<std::uint64_t>(n);
    }

    RowGroup row_group() {
        RowGroup group;
        thrift_.structure([&](std::int64_t id, Type type) {
            if (id == 1) thrift_.list(type, [&](Type) { group.chunks.push_back(chunk()); });
            if (id == 3) group.rows = count(thrift_.whole(type), "rows");
            return id == 1 || id == 3;
        });
        return group;
    }

    Chunk chunk() {
        Chunk chunk;
        bool has_metadata = false;
        thrift_.structure([&](std::int64_t id, Type type) {
            if (id == 1 && !thrift_.binary(type).empty())
                chunk.why_not = "keeps its values in another file, which is not read";
            if (id == 3) {
                metadata(chunk);
                has_metadata = true;
            }
            if (id == 8 || id == 9) chunk.why_not = "is encrypted, which is not read";
            return id == 1 || id == 3;
        });
        if (!has_metadata && chunk.why_not.empty()) chunk.why_not = "does not say where it lies";
        return chunk;
    }

    void metadata(Chunk& chunk) {
        std::uint64_t data = 0;
        std::uint64_t dictionary = 0;
        thrift_.structure([&](std::int64_t id, Type type) {
            switch (id) {
                case 4: chunk.codec = thrift_.whole(type); return true;
                case 5: chunk.values = count(thrift_.whole(type), "values"); return true;
                case 7: chunk.bytes = count(thrift_.whole(type), "bytes"); return true;
                case 9: data = count(thrift_.whole(type), "bytes"); return true;
                case 11: dictionary = count(thrift_.whole(type), "bytes"); return true;
                default: return false;
            }
        });
        chunk.begin = dictionary > 0 && dictionary < data ? dictionary : data;
        if (chunk.why_not.empty() &&
            (chunk.begin > data_bytes_ || chunk.bytes > data_bytes_ - chunk.begin))
            chunk.why_not = "lies at bytes " + std::to_string(chunk.begin) + " to " +
                            std::to_string(chunk.begin + chunk.bytes) + ", the file has " +
                            std::to_string(data_bytes_) + " of data: it is cut or damaged";
    }

    Thrift thrift_;
    std::uint64_t data_bytes_;
    Footer footer_;
};

}  // namespace

Footer read_footer(std::string_view file) {
    constexpr std::size_t kLeast = 12;
    if (file.starts_with(kEncrypted))
        refuse("is encrypted (it begins with PARE), which is not read");
    if (!file.starts_with(kMagic)) refuse("is no Parquet file: it does not begin with PAR1");
    if (file.ends_with(kEncrypted)) refuse("is encrypted (it ends with PARE), which is not read");
    if (file.size() < kLeast || !file.ends_with(kMagic))
        refuse("is cut: it does not end with PAR1");
    Cursor tail(file.substr(file.size() - 8));
    const auto length = tail.number<std::uint32_t>("its footer");
    if (length > file.size() - kLeast)
        refuse("has a footer of " + std::to_string(length) + " bytes, the whole file has " +
               std::to_string(file.size()));
    if (length > kMaxFooterBytes)
        refuse("has a footer of " + std::to_string(length) + " bytes, at most " +
               std::to_string(kMaxFooterBytes) + " are read");
    const std::size_t begin = file.size() - 8 - length;
    return parse_footer(file.substr(begin, length), begin);
}

Footer parse_footer(std::string_view bytes, std::uint64_t begin) {
    return FooterReader(bytes, begin).read();
}

/// A bool is a byte in a list, and the type itself in a struct.
void Thrift::pass_over_element(Type type) {
    if (type == Type::yes || type == Type::no)
        bytes_.byte(kWhat);
    else
        pass_over(type);
}

void Thrift::pass_over(Type type) {
    switch (type) {
        case Type::yes:
        case Type::no: return;
        case Type::i8: bytes_.byte(kWhat); return;
        case Type::i16:
        case Type::i32:
        case Type::i64: bytes_.varint(kWhat); return;
        case Type::real: bytes_.take(8, kWhat); return;
        case Type::binary: binary(type); return;
        case Type::list:
        case Type::set: list(type, [&](Type element) { pass_over_element(element); }); return;
        case Type::map: {
            const Nested nested(depth_);
            const std::uint64_t count = bytes_.varint(kWhat);
            if (count == 0) return;
            if (count > bytes_.rest().size()) wrong();
            const std::uint8_t types = bytes_.byte(kWhat);
            for (std::uint64_t i = 0; i < count; ++i) {
                pass_over_element(static_cast<Type>(types >> 4U));
                pass_over_element(static_cast<Type>(types & 0x0fU));
            }
            return;
        }
        case Type::structure: structure([](std::int64_t, Type) { return false; }); return;
        case Type::stop: break;
    }
    wrong();
}

}  // namespace etlc::recordings::parquet
