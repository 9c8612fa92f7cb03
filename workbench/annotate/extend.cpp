#include "annotate/extend.hpp"

#include <zstd.h>

#include <algorithm>
#include <bit>

#include "recordings/parquet/footer.hpp"

namespace etlc::annotate {

using namespace recordings::parquet;

namespace {

using Kind = NewColumn::Kind;

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

Field text(std::int64_t id, std::string_view value) {
    return {id, Type::binary, binary(value)};
}

Field structure(std::int64_t id, const Structure& fields) {
    return {id, Type::structure, bytes_of(fields)};
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

/// A column without fields below it. Each of its entries has a level of repetition and one of
/// definition.
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

/// `converted`, `logical`: the numbers of a type; none where it is the physical one.
std::string element(const std::string& name, Repetition repetition, Field size_or_type,
                    std::int64_t converted = 0, std::int64_t logical = 0) {
    Structure fields = {number(3, Type::i32, repetition), text(4, name)};
    fields.insert(size_or_type.id < 3 ? fields.begin() : fields.end(), std::move(size_or_type));
    if (logical > 0) {
        fields.push_back(number(6, Type::i32, converted));
        fields.push_back(structure(10, {structure(logical, {})}));
    }
    return bytes_of(fields);
}

std::string leaf_element(const std::string& name, Physical physical) {
    constexpr std::int64_t kUtf8 = 0, kString = 1;
    const Field type = number(1, Type::i32, static_cast<std::int64_t>(physical));
    return physical == Physical::binary ? element(name, kOptional, type, kUtf8, kString)
                                        : element(name, kOptional, type);
}

std::string group(const std::string& name, Repetition repetition, std::size_t children) {
    return element(name, repetition, number(5, Type::i32, static_cast<std::int64_t>(children)));
}

std::string list(const std::string& name) {
    constexpr std::int64_t kConverted = 3, kLogical = 3;
    return element(name, kOptional, number(5, Type::i32, 1), kConverted, kLogical);
}

Shape shape_of_list(const std::string& name, bool has_times) {
    std::vector<std::pair<std::string, Physical>> members = {
        {"role", Physical::binary}, {"content", Physical::binary}, {"style", Physical::binary}};
    if (has_times) members.emplace_back("timestamp", Physical::float32);
    members.emplace_back("camera", Physical::binary);
    Shape shape;
    shape.elements = {list(name), group("list", kRepeated, 1),
                      group("element", kOptional, members.size() + 1)};
    for (const auto& [member, physical] : members) {
        shape.elements.push_back(leaf_element(member, physical));
        shape.leaves.push_back({{name, "list", "element", member}, physical, 1, 4});
    }
    shape.elements.push_back(list("tool_calls"));
    shape.elements.push_back(group("list", kRepeated, 1));
    shape.elements.push_back(leaf_element("element", Physical::binary));
    shape.leaves.push_back(
        {{name, "list", "element", "tool_calls", "list", "element"}, Physical::binary, 2, 6});
    return shape;
}

Shape shape_of(const NewColumn& column) {
    if (column.kind >= Kind::language)
        return shape_of_list(column.name, column.kind == Kind::language);
    const Physical physical = column.kind == Kind::boolean ? Physical::boolean
                              : column.kind == Kind::int64 ? Physical::int64
                                                           : Physical::float32;
    return {{leaf_element(column.name, physical)}, {{{column.name}, physical}}};
}

// The values.

/// Packs numbers of a few bits, the lowest bits first.
std::string packed(std::string_view numbers, unsigned bits) {
    std::string bytes((numbers.size() + 7) / 8 * bits, '\0');
    for (std::size_t i = 0; i < numbers.size(); ++i)
        for (unsigned b = 0; b < bits; ++b) {
            const std::size_t at = i * bits + b;
            if ((numbers[i] >> b & 1) != 0) bytes[at / 8] |= static_cast<char>(1U << at % 8);
        }
    return bytes;
}

/// The levels of a page: one run of packed numbers, behind its length.
std::string levels(const std::string& numbers, std::uint8_t most) {
    if (most == 0) return "";
    const auto bits = static_cast<unsigned>(std::bit_width(static_cast<unsigned>(most)));
    const std::string run = varint((numbers.size() + 7) / 8 << 1U | 1U) + packed(numbers, bits);
    std::string bytes;
    append(bytes, static_cast<std::uint32_t>(run.size()));
    return bytes + run;
}

std::string compressed(const std::string& bytes) {
    std::string result(ZSTD_compressBound(bytes.size()), '\0');
    const std::size_t size =
        ZSTD_compress(result.data(), result.size(), bytes.data(), bytes.size(), 3);
    if (ZSTD_isError(size) != 0) refuse("cannot be extended: a page cannot be compressed");
    result.resize(size);
    return result;
}

/// The entries of a page. A level is a character of its number.
struct Page {
    std::string repetitions;
    std::string definitions;
    std::string values;
};

/// The values of a column, by row.
class Values {
public:
    explicit Values(const NewColumn& column) : column_(column) {
        for (const NewColumn::Run& run : column.lists)
            lists_.insert(lists_.end(), run.rows, &run.sayings);
    }

    std::uint64_t rows() const {
        return column_.kind >= Kind::language ? lists_.size() : column_.values.size() / bytes();
    }

    /// Returns the values of a leaf in rows from `row` up to `end`, as many as a page has, and
    /// moves `row` behind these.
    Page page(const Leaf& leaf, std::uint64_t& row, std::uint64_t end) const {
        constexpr std::size_t kPageEntries = 1U << 16U;
        Page page;
        if (column_.kind < Kind::language) {
            const std::size_t count = std::min<std::uint64_t>(end - row, kPageEntries);
            page.definitions.assign(count, '\1');
            page.values = column_.values.substr(row * bytes(), count * bytes());
            if (column_.kind == Kind::boolean) page.values = packed(page.values, 1);
            row += count;
            return page;
        }
        for (; row < end && page.definitions.size() < kPageEntries; ++row) {
            char repetition = 0;
            for (const Saying& saying : *lists_[row]) {
                page.repetitions += repetition;
                repetition = 1;
                add_member(page, leaf, saying);
            }
            if (!lists_[row]->empty()) continue;
            page.repetitions += '\0';
            page.definitions += '\1';  // a list without elements
        }
        return page;
    }

private:
    std::size_t bytes() const {
        return column_.kind == Kind::boolean ? 1 : column_.kind == Kind::int64 ? 8 : 4;
    }

    static void add_member(Page& page, const Leaf& leaf, const Saying& saying) {
        const std::string& name = leaf.path[3];
        const bool is_null = name == "camera" || name == "tool_calls";
        page.definitions += static_cast<char>(is_null ? 3 : leaf.most_defined);
        if (is_null) return;
        if (name == "timestamp") return append(page.values, saying.timestamp);
        const std::string& value = name == "content" ? saying.content
                                   : name == "role"  ? kRole
                                                     : kStyle;
        append(page.values, static_cast<std::uint32_t>(value.size()));
        page.values += value;
    }

    inline static const std::string kRole = "assistant";
    inline static const std::string kStyle = "subtask";

    const NewColumn& column_;
    std::vector<const std::vector<Saying>*> lists_;  ///< of each row
};

/// Writes the pages of a leaf in the rows of a row group, and adds the chunk to its metadata.
void add_chunk(Structure& group, const Values& values, const Leaf& leaf, std::uint64_t row,
               std::uint64_t end, std::uint64_t kept, std::string& file) {
    const std::uint64_t begin = kept + file.size();
    std::int64_t entries = 0;
    std::int64_t unpacked = 0;
    do {
        const Page page = values.page(leaf, row, end);
        const std::string bytes = levels(page.repetitions, leaf.most_repeated) +
                                  levels(page.definitions, leaf.most_defined) + page.values;
        const std::string body = compressed(bytes);
        const auto count = static_cast<std::int64_t>(page.definitions.size());
        const std::string head = bytes_of(Structure{
            number(1, Type::i32, 0), number(2, Type::i32, static_cast<std::int64_t>(bytes.size())),
            number(3, Type::i32, static_cast<std::int64_t>(body.size())),
            structure(5, {number(1, Type::i32, count), number(2, Type::i32, 0),
                          number(3, Type::i32, 3), number(4, Type::i32, 3)})});
        file += head + body;
        unpacked += static_cast<std::int64_t>(head.size() + bytes.size());
        entries += count;
    } while (row < end);
    const auto size = static_cast<std::int64_t>(kept + file.size() - begin);
    std::vector<std::string> path;
    for (const std::string& part : leaf.path) path.push_back(binary(part));
    const Structure metadata = {number(1, Type::i32, static_cast<std::int64_t>(leaf.physical)),
                                list_field(2, Type::i32, {whole(0), whole(3)}),  // PLAIN, RLE
                                list_field(3, Type::binary, std::move(path)),
                                number(4, Type::i32, 6),  // ZSTD
                                number(5, Type::i64, entries),
                                number(6, Type::i64, unpacked),
                                number(7, Type::i64, size),
                                number(9, Type::i64, static_cast<std::int64_t>(begin))};
    Field& chunks = needed(group, 1);
    List list = list_in(chunks);
    list.of = Type::structure;
    list.elements.push_back(bytes_of(Structure{number(2, Type::i64, 0), structure(3, metadata)}));
    chunks.bytes = bytes_of(list);
    add_to(find(group, 2), unpacked);
    add_to(find(group, 6), size);
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
    const std::string root = element("schema", kRequired, number(5, Type::i32, 0));
    const Structure group = {list_field(1, Type::structure, {}), number(2, Type::i64, 0),
                             number(3, Type::i64, count)};
    std::vector<std::string> pairs;
    for (const auto& [key, value] : metadata)
        pairs.push_back(bytes_of(Structure{text(1, key), text(2, value)}));
    return bytes_of(Structure{number(1, Type::i32, 1), list_field(2, Type::structure, {root}),
                              number(3, Type::i64, count),
                              list_field(4, Type::structure, {bytes_of(group)}),
                              list_field(5, Type::structure, std::move(pairs)), text(6, "etlc")});
}

/// The parts of a footer that new columns change.
struct Metadata {
    explicit Metadata(std::string_view footer)
        : fields(fields_in(footer)),
          schema(list_in(needed(fields, 2))),
          groups(list_in(needed(fields, 4))) {}

    Structure fields;
    List schema;
    List groups;
};

/// Refuses a column that is there already, and one of other rows.
void refuse_unfit(const Footer& old, const NewColumn& column, std::uint64_t rows) {
    for (const Column& there : old.columns)
        if (there.name == column.name) refuse("has a column '" + column.name + "' already");
    if (rows != old.rows)
        refuse("has " + std::to_string(old.rows) + " rows, and there are values for " +
               std::to_string(rows));
}

/// Adds the pages of a column to what follows the first `kept` bytes of the file.
void add_column(Metadata& metadata, const Footer& old, const NewColumn& column, std::uint64_t kept,
                std::string& bytes) {
    const Values values(column);
    refuse_unfit(old, column, values.rows());
    const Shape shape = shape_of(column);
    List& schema = metadata.schema;
    Structure root = fields_in(schema.elements[0]);
    add_to(&needed(root, 5), 1);
    schema.elements[0] = bytes_of(root);
    schema.elements.insert(schema.elements.end(), shape.elements.begin(), shape.elements.end());
    for (const Leaf& leaf : shape.leaves) {
        std::uint64_t row = 0;
        for (std::size_t g = 0; g < old.groups.size(); ++g) {
            Structure group = fields_in(metadata.groups.elements[g]);
            const std::uint64_t end = row + old.groups[g].rows;
            add_chunk(group, values, leaf, row, end, kept, bytes);
            metadata.groups.elements[g] = bytes_of(group);
            row = end;
        }
    }
    Field* const orders = find(metadata.fields, 7);
    if (orders == nullptr) return;
    List list = list_in(*orders);  // the order of the type, for each leaf
    const std::string of_type = bytes_of(Structure{structure(1, {})});
    list.elements.insert(list.elements.end(), shape.leaves.size(), of_type);
    orders->bytes = bytes_of(list);
}

}  // namespace

std::string extension(std::string_view footer, std::uint64_t kept,
                      const std::vector<NewColumn>& columns) {
    const Footer old = parse_footer(footer, kept);
    for (const RowGroup& group : old.groups)
        for (const Chunk& chunk : group.chunks)
            if (!chunk.why_not.empty()) refuse("has a column that " + chunk.why_not);
    Metadata metadata(footer);
    if (metadata.groups.elements.size() != old.groups.size())
        refuse("repeats a field of its metadata");
    std::string bytes;
    for (const NewColumn& column : columns) add_column(metadata, old, column, kept, bytes);
    Structure& fields = metadata.fields;
    needed(fields, 2).bytes = bytes_of(metadata.schema);
    needed(fields, 4).bytes = bytes_of(metadata.groups);
    drop_descriptions(fields);
    const std::string longer = bytes_of(fields);
    if (longer.size() > kMaxFooterBytes) refuse("cannot be extended: its footer gets too large");
    bytes += longer;
    append(bytes, static_cast<std::uint32_t>(longer.size()));
    return bytes + std::string(kMagic);
}

std::string new_file(std::uint64_t rows,
                     const std::vector<std::pair<std::string, std::string>>& metadata,
                     const std::vector<NewColumn>& columns) {
    return std::string(kMagic) + extension(empty_footer(rows, metadata), kMagic.size(), columns);
}

}  // namespace etlc::annotate
