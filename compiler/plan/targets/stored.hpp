// Target sets and projections that are not spelled out in the header: they lie in a file beside
// it, which the monitor is given. Takes: a plan. Gives: which sets, where in the file each begins,
// and the bytes of the file. Keeps true: rows are little-endian float32 in the form that the
// kernels want, each padded with zeros to a multiple of 64 bytes; sets stand in the order of the
// plan's distances; the same plan gives the same bytes on every machine.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "plan/program/program.hpp"

namespace etlc::plan {

/// The sets of the plan's distances that are larger than `inline_bytes`, then the matrices of their
/// projections that are.
std::vector<StoredSet> stored_sets(const Plan& plan, std::uint64_t inline_bytes);

/// Where the distance's set lies in the file; null where it stands in the header.
const StoredSet* stored_set(const Plan& plan, Index distance);

/// The same of a projection's matrix.
const StoredSet* stored_projection(const Plan& plan, Index projection);

/// What is stored, as it is declared.
struct StoredNumbers {
    const std::string& name;
    const std::string& origin;
    source::Span span;
    const std::vector<float>& values;
    std::uint32_t rows;
    std::uint32_t dimension;
};
StoredNumbers numbers_of(const check::Model& model, const StoredSet& set);

/// The monitor searches the distance's set, which takes state (etlmon/distance/search.hpp), and
/// does not measure all of it.
bool searches(const Plan& plan, Index distance);

/// What such a search remembers.
std::uint64_t search_bytes(const check::Target& target);

/// Bytes of the file; 0 where there is none.
std::uint64_t stored_bytes(const Plan& plan);

/// The file, piece by piece, for as long as `take` says true. Gives whether it always did.
bool store(const Plan& plan,
           const std::function<bool(const std::uint8_t* bytes, std::size_t size)>& take);

/// The file's XXH64.
std::uint64_t stored_hash(const Plan& plan);

}  // namespace etlc::plan
