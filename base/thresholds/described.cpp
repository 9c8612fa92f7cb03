#include "thresholds/described.hpp"

#include <fmt/format.h>

#include <cmath>

#include "data/arrays/array.hpp"
#include "data/text/quote.hpp"
#include "thresholds/thresholds.hpp"

namespace etlc::thresholds {

using data::in_quotes;
using diag::Code;
using diag::Failure;

diag::Result<Json> read_description(const data::Archive& archive, const Description& of,
                                    const ItemTakers& takers) {
    const auto bytes = archive.file(of.member, kMaxFileBytes);
    if (!bytes && bytes.failure().code == Code::no_such_array)
        return Failure{of.malformed, fmt::format("has no member '{}', expected a file that '{}' "
                                                 "wrote",
                                                 of.member, of.command)};
    if (!bytes) return bytes.failure();
    Text text(**bytes, kMaxDescriptionBytes, of.malformed);
    auto root = parse_json(text, kMaxDescriptionValues, of.malformed, of.invalid, takers);
    if (text.failure()) return *text.failure();
    // A damaged archive is that first of all: reading on to the end compares the checksum.
    const std::uint64_t size = text.finish();
    if (text.failure()) return *text.failure();
    if (size != (*bytes)->size())
        return Failure{Code::malformed_archive,
                       fmt::format("member {} has other than {} bytes", in_quotes(of.member),
                                   (*bytes)->size())};
    return root;
}

DescribedArrays::Numbers DescribedArrays::floats(const std::string& key, std::size_t rank,
                                                 std::string_view meaning) {
    if (failure_) return {};
    const auto array = read(key);
    if (!array) {
        failure_ = array.failure();
        return {};
    }
    const auto wrong = [&](const std::string& what) {
        failure_ = Failure{code_, fmt::format("array {} {}", in_quotes(key), what)};
    };
    if (array->element != data::Element::f32)
        wrong(fmt::format("has elements of {}, expected float32", name(array->element)));
    else if (array->shape.size() != rank || array->values.empty())
        wrong(fmt::format("has shape {}, expected {}", array->shape_text(), meaning));
    for (std::size_t i = 0; i < array->values.size() && !failure_; ++i)
        if (!std::isfinite(array->values[i]))
            wrong(fmt::format("holds {} at element {}, expected finite numbers", array->values[i],
                              i));
    if (failure_) return {};
    return {array->shape, {array->values.begin(), array->values.end()}};
}

diag::Result<data::Array> DescribedArrays::read(const std::string& key) {
    const auto source = archive_.member(key);
    if (!source) return source.failure();
    bytes_ += (*source)->size();
    if ((*source)->size() > kMaxArrayBytes || bytes_ > kMaxArrayBytes)
        return Failure{Code::array_too_large,
                       fmt::format("the arrays up to {} take more than {} bytes, the most "
                                   "that are read",
                                   in_quotes(key), kMaxArrayBytes)};
    auto array = data::read_npy_from(**source);
    if (!array) return data::in_array(array.failure(), key);
    return array;
}

std::string path_beside(const std::string& spec_path, std::string_view ending) {
    constexpr std::string_view kEnding = ".etl";
    std::string stem = spec_path;
    if (stem.ends_with(kEnding)) stem.resize(stem.size() - kEnding.size());
    return stem.append(ending);
}

}  // namespace etlc::thresholds
