// Recorded traces of all formats, opened by their path.
// Takes: FILE.csv, FILE.npz, FILE.h5, FILE.h5:GROUP, FOLDER:3 of a data set, or - for CSV on
// standard input. Gives: the trace. Keeps true: the ending alone says what the format is.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "data/traces/trace.hpp"

namespace etlc::data {

/// Whether the ending of a path is that of a trace.
bool is_trace(const std::string& path);
/// The endings of traces: ".csv, .npz, .h5 or .hdf5".
std::string trace_endings();

/// The path of a trace that comes on standard input, as CSV. It is read once.
inline constexpr std::string_view kStandardInput = "-";

/// Of FILE.h5:GROUP the file, of an episode of a data set its folder, of any other path the path
/// itself.
std::string trace_file(const std::string& path);

/// A trace that ends before its first step: neither verdicts nor thresholds come of it.
diag::Failure no_steps();

/// The finding as a diagnostic whose place is the trace; where something is looked for by the wrong
/// name, it says how to give another.
diag::Diagnostic in_trace(const diag::Failure& failure, const std::string& path);

/// Opens a trace. Every channel that is not optional must be there; extra columns and arrays are
/// ignored, but not elements of a vector beyond its width. Shapes in .npz and .h5: T or T x 1 for
/// scalars and bools, T x D for vectors (T too where D is 1). Failures, here and in `next`, are
/// E08; their messages do not repeat the path: `in_trace` adds it.
diag::Result<std::unique_ptr<Trace>> open_trace(const std::string& path,
                                                const std::vector<Channel>& channels);

}  // namespace etlc::data
