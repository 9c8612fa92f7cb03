// Archives of arrays with a description: what is fitted, what is embedded.
// Takes: an .npz archive, the name of its description, a JSON member, and the codes of what may be
// wrong with it. Gives: the description's tree, and the float32 arrays that it names. Keeps true:
// all numbers are finite; no array takes more than its file, and all together no more than
// kMaxArrayBytes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "data/arrays/archive.hpp"
#include "data/arrays/array.hpp"
#include "diag/diag.hpp"
#include "thresholds/fields.hpp"

namespace etlc::thresholds {

/// Archives whose arrays take more are refused, and so are descriptions of which more stays in
/// memory, as kMaxKeptBytes and kMaxValues have it.
inline constexpr std::uint64_t kMaxArrayBytes = 256ULL << 20U;
inline constexpr std::uint64_t kMaxDescriptionBytes = 64ULL << 20U;
inline constexpr std::uint64_t kMaxDescriptionValues = 1ULL << 21U;

/// What sort of archive it is.
struct Description {
    std::string member;   ///< "fitted.json"
    std::string command;  ///< that writes it: "etlc fit"
    diag::Code malformed;
    diag::Code unknown_format;
    diag::Code invalid;
};

/// The description as a tree, but for the items that are taken.
diag::Result<Json> read_description(const data::Archive& archive, const Description& of,
                                    const ItemTakers& takers = {});

/// Reads the fields of a description, and the arrays that it names.
class DescribedArrays : protected Fields {
protected:
    DescribedArrays(const data::Archive& archive, const Description& of)
        : Fields(of.invalid, of.unknown_format), archive_(archive), code_(of.invalid) {}

    struct Numbers {
        std::vector<std::uint64_t> shape;
        std::vector<float> values;
    };
    /// Finite float32 values, none of its dimensions 0; empty after a failure. `meaning`: of the
    /// dimensions, "rows x dimension".
    Numbers floats(const std::string& key, std::size_t rank, std::string_view meaning);

private:
    diag::Result<data::Array> read(const std::string& key);

    const data::Archive& archive_;
    diag::Code code_;
    std::uint64_t bytes_ = 0;  ///< of the arrays so far
};

/// SPEC.etl to SPEC and this ending, ".fitted.npz".
std::string path_beside(const std::string& spec_path, std::string_view ending);

}  // namespace etlc::thresholds
