#include "recordings/parquet/extend.hpp"

#include <zstd.h>

#include <algorithm>
#include <bit>

namespace etlc::recordings::parquet {

namespace {

constexpr std::size_t kPageEntries = 1U << 16U;

// Thrift's compact protocol, written. Structs and lists that are not changed stay bytes.

std::string varint(std::uint64_t value) {
    std::string bytes;
    for (; value >= 0x80; value >>= 7U) bytes += static_cast<char>(value | 0x80U);
    return bytes + static_cast<char>(value);
}

std::string whole(std::int64_t value) {
    return varint(static_cast<std::uint64_t>(value) << 1U ^
                  static_cast<std::uint64_t>(value >> 63U));
}

std::string binary(std::string_view text) {
    return varint(text.size()) + std::string(text);
}

struct Field {
    std::int64_t id = 0;
    Type type = Type::structure;
    std::string bytes;
};
using Structure = std::vector<Field>;

struct List {
    Type of = Type::structure;
    std::vector<std::string> elements;
};

template <class Read>
std::string taken(Thrift& thrift, const Read& read) {
    const std::string_view before = thrift.rest();
    read();
    return std::string(before.substr(0, before.size() - thrift.rest().size()));
}

Structure fields_in(std::string_view bytes) {
    Thrift thrift(bytes);
    Structure fields;
    thrift.structure([&](std::int64_t id, Type type) {
        fields.push_back({id, type, taken(thrift, [&] { thrift.pass_over(type); })});
        return true;
    });
    return fields;
}

List list_in(const Field& field) {
    Thrift thrift(field.bytes);
    List list;
    thrift.list(field.type, [&](Type of) {
        list.elements.push_back(taken(thrift, [&] { thrift.pass_over_element(of); }));
    });
    list.of = static_cast<Type>(field.bytes[0] & 0x0f);
    return list;
}

std::string bytes_of(const Structure& fields) {
    std::string bytes;
    std::int64_t last = 0;
    for (const Field& field : fields) {
        const std::int64_t ahead = field.id - last;
        const auto type = static_cast<unsigned>(field.type);
        const bool is_near = ahead > 0 && ahead <= 15;
        bytes += static_cast<char>(is_near ? static_cast<unsigned>(ahead) << 4U | type : type);
        if (!is_near) bytes += whole(field.id);
        bytes += field.bytes;
        last = field.id;
    }
    return bytes + '\0';
}

std::string bytes_of(const List& list) {
    const auto type = static_cast<unsigned>(list.of);
    const bool is_short = list.elements.size() < 15;
    std::string bytes(1, static_cast<char>((is_short ? list.elements.size() : 15U) << 4U | type));
    if (!is_short) bytes += varint(list.elements.size());
    for (const std::string& element : list.elements) bytes += element;
    return bytes;
}

Field number(std::int64_t id, Type type, std::int64_t value) {
    return {id, type, whole(value)};
}

Field list_field(std::int64_t id, Type of, std::vector<std::string> elements) {
    return {id, Type::list, bytes_of(List{of, std::move(elements)})};
}

Field* find(Structure& fields, std::int64_t id) {
    const auto found =
        std::find_if(fields.begin(), fields.end(), [&](const Field& f) { return f.id == id; });
    return found == fields.end() ? nullptr : &*found;
}

Field& needed(Structure& fields, std::int64_t id) {
    Field* const field = find(fields, id);
    if (field == nullptr) refuse("lacks a field of its metadata");
    return *field;
}

void add_to(Field* field, std::int64_t n) {
    if (field == nullptr) return;
    field->bytes = whole(Thrift(field->bytes).whole(field->type) + n);
}

// The schema of the new columns.

std::string element(const std::string& name, Repetition repetition, Physical physical) {
    Structure fields = {number(1, Type::i32, static_cast<std::int64_t>(physical)),
                        number(3, Type::i32, repetition),
                        {4, Type::binary, binary(name)}};
    if (physical == Physical::binary) {  // UTF8, STRING
        fields.push_back(number(6, Type::i32, 0));
        fields.push_back({10, Type::structure, bytes_of(Structure{{1, Type::structure, {'\0'}}})});
    }
    return bytes_of(fields);
}

std::string group(const std::string& name, Repetition repetition, std::int64_t children,
                  bool is_list = false) {
    Structure fields = {number(3, Type::i32, repetition),
                        {4, Type::binary, binary(name)},
                        number(5, Type::i32, children)};
    if (is_list) {
        fields.push_back(number(6, Type::i32, 3));
        fields.push_back({10, Type::structure, bytes_of(Structure{{3, Type::structure, {'\0'}}})});
    }
    return bytes_of(fields);
}

/// A leaf below a new column. Entries of it have a level of repetition and one of definition.
struct Leaf {
    std::vector<std::string> path;
    Physical physical = Physical::boolean;
    std::uint8_t most_repeated = 0;
    std::uint8_t most_defined = 1;
};

struct Shape {
    std::vector<std::string> elements;  ///< depth first
    std::vector<Leaf> leaves;
};

Shape shape_of_list(const std::string& name, bool has_times) {
    std::vector<std::pair<std::string, Physical>> members = {
        {"role", Physical::binary}, {"content", Physical::binary}, {"style", Physical::binary}};
    if (has_times) members.emplace_back("timestamp", Physical::float32);
    members.emplace_back("camera", Physical::binary);
    Shape shape;
    const auto count = static_cast<std::int64_t>(members.size()) + 1;
    shape.elements = {group(name, kOptional, 1, true), group("list", kRepeated, 1),
                      group("element", kOptional, count)};
    for (const auto& [member, physical] : members) {
        shape.elements.push_back(element(member, kOptional, physical));
        shape.leaves.push_back({{name, "list", "element", member}, physical, 1, 4});
    }
    for (std::string part : {group("tool_calls", kOptional, 1, true), group("list", kRepeated, 1),
                             element("element", kOptional, Physical::binary)})
        shape.elements.push_back(std::move(part));
    shape.leaves.push_back(
        {{name, "list", "element", "tool_calls", "list", "element"}, Physical::binary, 2, 6});
    return shape;
}

Shape shape_of(const NewColumn& column) {
    using Kind = NewColumn::Kind;
    if (column.kind == Kind::language || column.kind == Kind::events)
        return shape_of_list(column.name, column.kind == Kind::language);
    const Physical physical = column.kind == Kind::boolean ? Physical::boolean
                              : column.kind == Kind::int64 ? Physical::int64
                                                           : Physical::float32;
    return {{element(column.name, kOptional, physical)}, {{{column.name}, physical}}};
}

// The values.

/// Returns the bytes of a value; 0 for lists.
std::size_t bytes_of(NewColumn::Kind kind) {
    constexpr std::size_t kBytes[] = {1, 8, 4, 0, 0};
    return kBytes[static_cast<std::size_t>(kind)];
}

/// Packs numbers of a few bits, the lowest bits first.
std::string packed(const std::vector<std::uint8_t>& numbers, unsigned bits) {
    std::string bytes((numbers.size() + 7) / 8 * bits, '\0');
    for (std::size_t i = 0; i < numbers.size(); ++i)
        for (unsigned b = 0; b < bits; ++b) {
            const std::size_t at = i * bits + b;
            if ((numbers[i] >> b & 1U) != 0) bytes[at / 8] |= static_cast<char>(1U << at % 8);
        }
    return bytes;
}

/// The levels of a page: one run of packed numbers, behind its length.
std::string levels(const std::vector<std::uint8_t>& numbers, std::uint8_t most) {
    if (most == 0) return "";
    const auto bits = static_cast<unsigned>(std::bit_width(static_cast<unsigned>(most)));
    const std::string run = varint((numbers.size() + 7) / 8 << 1U | 1U) + packed(numbers, bits);
    const auto size = static_cast<std::uint32_t>(run.size());
    return std::string(reinterpret_cast<const char*>(&size), sizeof size) + run;
}

std::string compressed(const std::string& bytes) {
    std::string result(ZSTD_compressBound(bytes.size()), '\0');
    const std::size_t size =
        ZSTD_compress(result.data(), result.size(), bytes.data(), bytes.size(), 3);
    if (ZSTD_isError(size) != 0) refuse("cannot be extended: a page cannot be compressed");
    result.resize(size);
    return result;
}

/// The pages of a leaf in a row group.
class ChunkWriter {
public:
    ChunkWriter(const Leaf& leaf, const Send& send, std::uint64_t& at)
        : leaf_(leaf), send_(send), at_(at), begin_(at) {}

    void add(std::uint8_t repeated, std::uint8_t defined, std::string_view value = {}) {
        if (repeated == 0 && definitions_.size() >= kPageEntries) end_page();
        repetitions_.push_back(repeated);
        definitions_.push_back(defined);
        if (defined < leaf_.most_defined) return;
        if (leaf_.physical == Physical::boolean) return bools_.push_back(value[0] != 0 ? 1 : 0);
        if (leaf_.physical == Physical::binary) {
            const auto size = static_cast<std::uint32_t>(value.size());
            values_.append(reinterpret_cast<const char*>(&size), sizeof size);
        }
        values_ += value;
    }

    /// Returns the ColumnChunk; adds its bytes to those of the row group.
    std::string end(std::int64_t& unpacked_bytes, std::int64_t& packed_bytes) {
        if (!definitions_.empty() || values_so_far_ == 0) end_page();
        std::vector<std::string> path;
        for (const std::string& part : leaf_.path) path.push_back(binary(part));
        const auto size = static_cast<std::int64_t>(at_ - begin_);
        const Structure metadata = {number(1, Type::i32, static_cast<std::int64_t>(leaf_.physical)),
                                    list_field(2, Type::i32, {whole(0), whole(3)}),  // PLAIN, RLE
                                    list_field(3, Type::binary, std::move(path)),
                                    number(4, Type::i32, 6),  // ZSTD
                                    number(5, Type::i64, values_so_far_),
                                    number(6, Type::i64, unpacked_),
                                    number(7, Type::i64, size),
                                    number(9, Type::i64, static_cast<std::int64_t>(begin_))};
        unpacked_bytes += unpacked_;
        packed_bytes += size;
        return bytes_of(
            Structure{number(2, Type::i64, 0), {3, Type::structure, bytes_of(metadata)}});
    }

private:
    void end_page() {
        const std::string page = levels(repetitions_, leaf_.most_repeated) +
                                 levels(definitions_, leaf_.most_defined) + packed(bools_, 1) +
                                 values_;
        const std::string body = compressed(page);
        const auto count = static_cast<std::int64_t>(definitions_.size());
        const Structure of_data = {number(1, Type::i32, count), number(2, Type::i32, 0),
                                   number(3, Type::i32, 3), number(4, Type::i32, 3)};
        const std::string head =
            bytes_of(Structure{number(1, Type::i32, 0),
                               number(2, Type::i32, static_cast<std::int64_t>(page.size())),
                               number(3, Type::i32, static_cast<std::int64_t>(body.size())),
                               {5, Type::structure, bytes_of(of_data)}});
        send_(head + body);
        at_ += head.size() + body.size();
        unpacked_ += static_cast<std::int64_t>(head.size() + page.size());
        values_so_far_ += count;
        repetitions_.clear();
        definitions_.clear();
        bools_.clear();
        values_.clear();
    }

    const Leaf& leaf_;
    const Send& send_;
    std::uint64_t& at_;  ///< in the file
    std::uint64_t begin_;
    std::vector<std::uint8_t> repetitions_;
    std::vector<std::uint8_t> definitions_;
    std::vector<std::uint8_t> bools_;
    std::string values_;
    std::int64_t values_so_far_ = 0;
    std::int64_t unpacked_ = 0;
};

/// Walks through the rows of a column, for one leaf.
class Cells {
public:
    explicit Cells(const NewColumn& column) : column_(column) {}

    void add_row(ChunkWriter& to, const Leaf& leaf) {
        if (column_.lists.empty()) {
            const std::size_t size = bytes_of(column_.kind);
            return to.add(0, 1, std::string_view(column_.values).substr(size * row_++, size));
        }
        while (row_ == column_.lists[run_].rows) {
            ++run_;
            row_ = 0;
        }
        ++row_;
        const std::vector<Saying>& sayings = column_.lists[run_].sayings;
        if (sayings.empty()) return to.add(0, 1);  // a list without elements
        for (std::size_t i = 0; i < sayings.size(); ++i)
            add_member(to, leaf, i > 0 ? 1 : 0, sayings[i]);
    }

private:
    static void add_member(ChunkWriter& to, const Leaf& leaf, std::uint8_t repeated,
                           const Saying& saying) {
        constexpr std::uint8_t kNull = 3;
        const std::string& name = leaf.path[3];
        if (name == "role") return to.add(repeated, leaf.most_defined, "assistant");
        if (name == "style") return to.add(repeated, leaf.most_defined, "subtask");
        if (name == "content") return to.add(repeated, leaf.most_defined, saying.content);
        if (name != "timestamp") return to.add(repeated, kNull);
        const auto* const bytes = reinterpret_cast<const char*>(&saying.timestamp);
        to.add(repeated, leaf.most_defined, {bytes, sizeof saying.timestamp});
    }

    const NewColumn& column_;
    std::size_t run_ = 0;
    std::uint64_t row_ = 0;  ///< the next one, of the run where there are runs
};

/// Adds a chunk to a row group.
void add_chunk(Structure& group, ChunkWriter& chunk) {
    std::int64_t unpacked = 0;
    std::int64_t packed = 0;
    Field& chunks = needed(group, 1);
    List list = list_in(chunks);
    list.of = Type::structure;
    list.elements.push_back(chunk.end(unpacked, packed));
    chunks.bytes = bytes_of(list);
    add_to(find(group, 2), unpacked);
    add_to(find(group, 6), packed);
}

/// Drops metadata that describe the columns, and would be believed before the schema.
void drop_descriptions(Structure& fields) {
    Field* const pairs = find(fields, 5);
    if (pairs == nullptr) return;
    List list = list_in(*pairs);
    std::erase_if(list.elements, [](const std::string& pair) {
        Structure parts = fields_in(pair);
        Field& key = needed(parts, 1);
        const std::string_view name = Thrift(key.bytes).binary(key.type);
        return name == "ARROW:schema" || name == "pandas";
    });
    pairs->bytes = bytes_of(list);
    if (list.elements.empty()) fields.erase(fields.begin() + (pairs - fields.data()));
}

/// The footer of a file without columns.
std::string empty_footer(std::uint64_t rows,
                         const std::vector<std::pair<std::string, std::string>>& metadata) {
    const auto count = static_cast<std::int64_t>(rows);
    const Structure root = {{4, Type::binary, binary("schema")}, number(5, Type::i32, 0)};
    const Structure group = {list_field(1, Type::structure, {}), number(2, Type::i64, 0),
                             number(3, Type::i64, count)};
    std::vector<std::string> pairs;
    for (const auto& [key, value] : metadata)
        pairs.push_back(
            bytes_of(Structure{{1, Type::binary, binary(key)}, {2, Type::binary, binary(value)}}));
    return bytes_of(Structure{number(1, Type::i32, 1),
                              list_field(2, Type::structure, {bytes_of(root)}),
                              number(3, Type::i64, count),
                              list_field(4, Type::structure, {bytes_of(group)}),
                              list_field(5, Type::structure, std::move(pairs)),
                              {6, Type::binary, binary("etlc")}});
}

}  // namespace

/// The parts of the footer that columns change, and its fields.
struct Extension::Metadata {
    explicit Metadata(std::string_view footer) : fields(fields_in(footer)) {
        schema = list_in(needed(fields, 2));
        for (const std::string& group : list_in(needed(fields, 4)).elements)
            groups.push_back(fields_in(group));
    }

    Structure fields;
    List schema;
    std::vector<Structure> groups;
};

Extension::Extension(std::string_view file) : old_(read_footer(file)) {
    for (const RowGroup& group : old_.groups)
        for (const Chunk& chunk : group.chunks)
            if (!chunk.why_not.empty()) refuse("has a column that " + chunk.why_not);
    Cursor tail(file.substr(file.size() - 8));
    const auto size = tail.number<std::uint32_t>("its footer");
    at_ = kept_ = file.size() - 8 - size;
    metadata_ = std::make_shared<Metadata>(file.substr(kept_, size));
    if (metadata_->groups.size() != old_.groups.size()) refuse("repeats a field of its metadata");
}

Extension::Extension(std::uint64_t rows,
                     const std::vector<std::pair<std::string, std::string>>& metadata)
    : metadata_(std::make_shared<Metadata>(empty_footer(rows, metadata))) {
    old_.rows = rows;
    old_.groups = {{rows, {}}};
}

/// Refuses a column that is there already, or has other rows than the file.
void Extension::check(const NewColumn& column) const {
    for (const Column& there : old_.columns)
        if (there.name == column.name) refuse("has a column '" + column.name + "' already");
    std::uint64_t rows = column.values.size() / std::max<std::size_t>(1, bytes_of(column.kind));
    for (const NewColumn::Run& run : column.lists) rows += run.rows;
    if (rows != old_.rows)
        refuse("has " + std::to_string(old_.rows) + " rows, and there are values for " +
               std::to_string(rows));
}

void Extension::add(const NewColumn& column, const Send& send) {
    check(column);
    if (at_ == 0) send(std::string(kMagic));
    at_ = std::max<std::uint64_t>(at_, kMagic.size());
    const Shape shape = shape_of(column);
    List& schema = metadata_->schema;
    Structure root = fields_in(schema.elements[0]);
    add_to(&needed(root, 5), 1);
    schema.elements[0] = bytes_of(root);
    schema.elements.insert(schema.elements.end(), shape.elements.begin(), shape.elements.end());
    for (const Leaf& leaf : shape.leaves) {
        Cells cells(column);
        for (std::size_t g = 0; g < old_.groups.size(); ++g) {
            ChunkWriter chunk(leaf, send, at_);
            for (std::uint64_t row = 0; row < old_.groups[g].rows; ++row)
                cells.add_row(chunk, leaf);
            add_chunk(metadata_->groups[g], chunk);
        }
    }
    Field* const orders = find(metadata_->fields, 7);
    if (orders == nullptr) return;
    List list = list_in(*orders);  // the order of the type, for each leaf
    list.elements.insert(list.elements.end(), shape.leaves.size(),
                         bytes_of(Structure{{1, Type::structure, {'\0'}}}));
    orders->bytes = bytes_of(list);
}

void Extension::end(const Send& send) {
    List groups;
    for (const Structure& group : metadata_->groups) groups.elements.push_back(bytes_of(group));
    Structure& fields = metadata_->fields;
    needed(fields, 2).bytes = bytes_of(metadata_->schema);
    needed(fields, 4).bytes = bytes_of(groups);
    drop_descriptions(fields);
    const std::string footer = bytes_of(fields);
    if (footer.size() > kMaxFooterBytes) refuse("cannot be extended: its footer gets too large");
    const auto size = static_cast<std::uint32_t>(footer.size());
    send(footer + std::string(reinterpret_cast<const char*>(&size), sizeof size) +
         std::string(kMagic));
}

}  // namespace etlc::recordings::parquet
