#include "artifacts/file.hpp"

#include <fmt/format.h>

#include "data/text/text.hpp"

namespace etlc::artifacts {

using diag::Code;
using diag::Failure;

namespace {

Json parse_description(const Kind& kind, const data::Archive& archive, const ItemTakers& takers) {
    const auto bytes = archive.file(kind.member, kMaxFileBytes);
    if (!bytes && bytes.failure().code == Code::no_such_array)
        throw Fault{{kind.malformed, fmt::format("has no member '{}', expected a file that '{}' "
                                                 "wrote",
                                                 kind.member, kind.command)}};
    if (!bytes) throw Fault{bytes.failure()};
    Text text(**bytes, kMaxKeptBytes, kind.malformed);
    Json root;
    std::optional<Fault> fault;
    try {
        root = parse_json(text, kMaxValues, kind.malformed, kind.invalid, takers);
    } catch (const Unreadable&) {
        throw;
    } catch (const Fault& found) {
        fault = found;
    }
    // Damage to the archive takes precedence: reading to the end compares the checksum.
    if (text.finish() != (*bytes)->size())
        throw Fault{{Code::malformed_archive,
                     fmt::format("member {} does not have the {} bytes that the archive lists",
                                 data::in_quotes(kind.member), (*bytes)->size())}};
    if (fault) throw Fault{*fault};
    return root;
}

/// Parses the tree by `parse(takers)` and reads its root.
template <class Parse>
std::optional<Failure> read(const Kind& kind, const data::Archive* archive, const Parse& parse,
                            const ReadRoot& read_root) {
    try {
        Items items(kind.invalid);
        Json root;
        std::optional<Fault> fault;
        try {
            root = parse(items.takers());
        } catch (const Fault& found) {
            fault = found;
        }
        if (const auto repeated = items.first_repeated()) return repeated;
        if (fault) return fault->failure;
        Reader::Shared shared{kind, items, archive};
        Reader reader(shared, root, "");
        read_root(reader);
        return std::nullopt;
    } catch (const Fault& fault) {
        return fault.failure;
    } catch (const data::SpillError& error) {
        return Failure{kind.unreadable, error.what()};
    }
}

}  // namespace

std::optional<Failure> read_text(const Kind& kind, data::ByteSource& source,
                                 const ReadRoot& read_root) {
    if (source.size() > kMaxFileBytes)
        return Failure{
            kind.unreadable,
            fmt::format("is larger than {} bytes, the most that is read", kMaxFileBytes)};
    const auto parse = [&](const ItemTakers& takers) {
        Text text(source, kMaxKeptBytes, kind.unreadable);
        return parse_json(text, kMaxValues, kind.malformed, kind.invalid, takers);
    };
    return read(kind, nullptr, parse, read_root);
}

std::optional<Failure> read_description(const Kind& kind, const data::Archive& archive,
                                        const ReadRoot& read_root) {
    const auto parse = [&](const ItemTakers& takers) {
        return parse_description(kind, archive, takers);
    };
    return read(kind, &archive, parse, read_root);
}

std::string path_beside(const std::string& spec_path, std::string_view ending) {
    constexpr std::string_view kEnding = ".etl";
    std::string stem = spec_path;
    if (stem.ends_with(kEnding)) stem.resize(stem.size() - kEnding.size());
    return stem.append(ending);
}

}  // namespace etlc::artifacts
