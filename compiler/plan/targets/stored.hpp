// Target sets and projections in a file beside the header, which is passed to the monitor. Rows are
// little-endian float32 in the form for the kernels, each padded with zeros to a multiple of 64
// bytes; sets are in the order of the plan's distances. The same plan gives the same bytes on every
// machine.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "plan/program/program.hpp"

namespace etlc::plan {

/// Returns the sets of the plan's distances larger than `inline_bytes`, then the matrices of their
/// projections.
std::vector<StoredSet> stored_sets(const Plan& plan, std::uint64_t inline_bytes);

/// Returns the distance's set in the file; null where it is in the header.
const StoredSet* stored_set(const Plan& plan, Index distance);

/// Returns a projection's matrix in the file; null where it is in the header.
const StoredSet* stored_projection(const Plan& plan, Index projection);

/// The declared numbers of a stored set.
struct StoredNumbers {
    const std::string& name;
    const std::string& origin;
    source::Span span;
    const std::vector<float>& values;
    std::uint32_t rows;
    std::uint32_t dimension;
};
StoredNumbers numbers_of(const check::Model& model, const StoredSet& set);

/// Returns whether the monitor searches the distance's set, which takes state
/// (etlmon/distance/search.hpp), instead of measuring all of it.
bool searches(const Plan& plan, Index distance);

/// Returns the bytes of state of such a search.
std::uint64_t search_bytes(const check::Target& target);

/// Returns the bytes of the file; 0 without one.
std::uint64_t stored_bytes(const Plan& plan);

/// Passes the file to `take` piece by piece until it returns false. Returns whether it never did.
bool store(const Plan& plan,
           const std::function<bool(const std::uint8_t* bytes, std::size_t size)>& take);

/// Returns the file's XXH64.
std::uint64_t stored_hash(const Plan& plan);

}  // namespace etlc::plan
