// Writes what monitors say of a data set into a copy of it, where LeRobot's tools look for it:
// `next.success`, subtasks in `language_persistent`, and progress in `sarm_progress.parquet`.
// Keeps true: all files of rows get the new columns, and meta/info.json lists them; the bytes of
// the old columns stay. Source: huggingface/lerobot, src/lerobot/datasets/language.py and
// rewards/sarm/rabc.py.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "annotate/judge.hpp"
#include "diag/diag.hpp"
#include "recordings/datasets/dataset.hpp"

namespace etlc::annotate {

/// The file of a written set that says what was annotated, by which spec, and which episodes are
/// undecided.
inline constexpr const char* kProvenance = "meta/etlc_annotations.json";
inline constexpr const char* kProgress = "sarm_progress.parquet";

struct Writing {
    recordings::Dataset& set;
    std::string output;  ///< the new folder; empty: the set is replaced
    Wanted wanted;
    std::string spec;       ///< its name
    std::string spec_hash;  ///< of its text
    std::string version;    ///< of etlc
};

/// The indices of the episodes that the monitor does not decide, or that are left out.
std::vector<std::uint64_t> undecided(const recordings::Dataset& set, const Judged& judged);

/// Says why the set cannot have these annotations.
std::optional<diag::Failure> refusal(const recordings::Dataset& set, const Wanted& wanted);

struct Written {
    std::uint64_t extended = 0;  ///< files of rows
    std::uint64_t copied = 0;
    std::uint64_t linked = 0;
};

/// Failures name the file in the folder.
diag::Result<Written> write(const Writing& writing, const Judged& judged);

}  // namespace etlc::annotate
