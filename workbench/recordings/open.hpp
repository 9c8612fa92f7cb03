// Opens recorded traces of all formats by their path.
// Takes: FILE.csv, FILE.npz, FILE.h5, FILE.h5:GROUP, FOLDER:3 of a data set, or - for CSV on
// standard input. Gives: the trace. Keeps true: the ending alone decides the format.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data/traces/trace.hpp"
#include "recordings/frames/frames.hpp"

namespace etlc::recordings {

/// Returns whether the ending of a path is that of a trace.
bool is_trace(const std::string& path);
/// Returns the endings of traces: ".csv, .npz, .h5 or .hdf5".
std::string trace_endings();

/// The path of a trace that comes on standard input, as CSV. It is read once.
inline constexpr std::string_view kStandardInput = "-";

/// The failure of a trace that has no step.
diag::Failure no_steps();

/// Makes a diagnostic about a trace. Where a name was not found, a note says how to give another.
diag::Diagnostic in_trace(const diag::Failure& failure, const std::string& path);

/// Opens a trace. Every channel that is not optional must be there; extra columns and arrays are
/// ignored, but not elements of a vector beyond its width. Shapes in .npz and .h5: T or T x 1 for
/// scalars and bools, T x D for vectors (T too where D is 1). Failures, here and in `next`, are
/// E08; their messages do not repeat the path: `in_trace` adds it.
diag::Result<std::unique_ptr<data::Trace>> open_trace(const std::string& path,
                                                      const std::vector<data::Channel>& channels);

/// Returns whether an episode says that it succeeded: `next.success` is true at some step, as in
/// data sets, or the attribute `success` of the episode's group in an .h5 file is. Nothing where
/// it has neither. Failures do not repeat the path.
diag::Result<std::optional<bool>> recorded_success(const std::string& path);

/// Names in the file by the names of the channels, where the two differ: `--map z=obs/z`.
using NamesInFile = std::map<std::string, std::string>;
std::vector<data::Channel> renamed(std::vector<data::Channel> channels, const NamesInFile& names);
const std::string& name_in_file(const std::string& name, const NamesInFile& names);

// Frames in arrays, T x H x W x 3 of uint8, or T x H x W of grey, in .npz and .h5 files.
// Keeps true: only one frame is in memory; an array of another shape or element type is a failure
// (E08) that names it.

/// Grey images may be shown, but an encoder that was made for colours gets none.
enum class Grey : std::uint8_t { refused, taken };

/// Opens an array of FILE.npz, FILE.h5 or FILE.h5:GROUP; an empty name stands for the only array of
/// images in colour. Failures do not repeat the path.
diag::Result<std::unique_ptr<FrameSource>> open_image_array(const std::string& path,
                                                            const std::string& name,
                                                            Grey grey = Grey::refused);

}  // namespace etlc::recordings
