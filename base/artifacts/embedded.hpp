// The file that `etlc embed` writes: embeddings of the images and videos that a spec names, and the
// encoders that made them. It is an .npz archive with the member embedded.json and an array for
// each entry. All numbers are finite, writing a file that was read gives the same bytes, and an
// encoder's fingerprint follows from its fields. check/ decides whether an entry fits the spec.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "diag/diag.hpp"

namespace etlc::embedded {

/// Kinds of encoder: ONNX Runtime, followed by its version, or a command (`--encoder-cmd`).
inline constexpr std::string_view kOnnxRuntime = "ONNX Runtime ";
inline constexpr std::string_view kCommand = "command";

/// Reference frames: pictures that etlc draws, the same in every version. Two encoders are the same
/// if they make the same embeddings of these.
inline constexpr std::uint32_t kReferenceFrames = 4;
/// The relative difference up to which embeddings of a frame are by the same encoder.
inline constexpr double kSameEncoder = 1e-3;
/// Returns |z - r| / |r|, or |z| where r is 0; infinity where it is not finite.
double relative_difference(const float* z, const float* r, std::size_t elements);

struct Encoder {
    std::string declaration;  ///< canonical text, "load(\"dino.onnx\"), image [224, 224]"
    std::string model;        ///< hash of the model's bytes, 16 hex digits
    std::string settings;     ///< canonical text, with those of the .json beside the model
    std::string kind;         ///< kOnnxRuntime and its version, or kCommand
    std::uint32_t dimension = 0;
    /// Its embeddings of the reference frames, a row each.
    std::vector<float> references;
};

/// Returns the identity of an encoder: XXH64 of model, settings and kind, 16 hex digits.
std::string fingerprint(const Encoder& encoder);

/// Returns the fingerprints of the same model and settings under every other kind, with the name of
/// the kind: a command, each release of ONNX Runtime.
std::map<std::string, std::string> fingerprints_otherwise(const Encoder& encoder);

/// An image or a video.
struct Source {
    std::string path;  ///< relative to the spec
    std::string hash;  ///< of the file's bytes, 16 hex digits
};

struct Entry {
    std::string encoder;  ///< a key of File::encoders
    std::uint32_t rows = 0;
    std::uint32_t columns = 0;
    std::vector<float> matrix;  ///< rows x columns, row-major
    std::string hash;           ///< data::content_hash of the matrix; not in the file
    std::vector<Source> sources;
};

struct File {
    std::string path;
    std::string spec;
    std::string etlc;                         ///< version that wrote the file
    std::map<std::string, Encoder> encoders;  ///< by name
    std::map<std::string, Entry> entries;  ///< by canonical text: "images(\"bay/*.png\") by dino"
};

/// Returns the default path of a spec's embeddings: SPEC.embedded.npz beside SPEC.etl.
std::string default_path(const std::string& spec_path);

/// Reads a file of embeddings. Failures have E04 and E10 codes; their messages name the key, and
/// `data::in_file` (data/files/file.hpp) adds the path.
diag::Result<File> read(const std::string& path);

/// Returns the bytes of the archive: embedded.json, and float32 arrays "references-1", ..., of
/// encoders, and "rows-1", ..., of entries.
std::string write(const File& file);

/// The encoders of an episode's inputs: input name -> fingerprint. An .npz episode that `etlc
/// embed` wrote holds them in its member embedded.json.
using Marks = std::map<std::string, std::string>;
/// A hash for each of these inputs: of its embeddings, and of all that they were made from.
using Origins = std::map<std::string, std::string>;
std::string write_marks(const Marks& marks, const Origins& origins = {});
/// Returns an empty map for an episode without marks.
diag::Result<Marks> read_marks(const std::string& path);
/// Returns an empty map for a file without origins, and for one that cannot be read.
Origins read_origins(const std::string& path);

}  // namespace etlc::embedded
