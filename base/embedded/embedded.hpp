// The file of embeddings: what `etlc embed` made of the images and videos that a spec names.
// Takes: an .npz archive of format 1: the member embedded.json, and an array for every entry.
// Gives: one entry per source of a target, and what is known of each encoder. Keeps true: writing
// what was read gives the same bytes; all numbers are finite; the fingerprint of an encoder follows
// from its fields; whether an entry is that of the spec is check/'s question.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "diag/diag.hpp"

namespace etlc::embedded {

/// What runs a model: ONNX Runtime, followed by its version, or a command (`--encoder-cmd`).
inline constexpr std::string_view kOnnxRuntime = "ONNX Runtime ";
inline constexpr std::string_view kCommand = "command";

struct Encoder {
    std::string declaration;  ///< canonical text, "load(\"dino.onnx\"), image [224, 224]"
    std::string model;        ///< hash of its bytes, 16 hex digits
    std::string settings;     ///< canonical text, those of the .json beside the model among them
    std::string kind;         ///< what runs it, as above
    std::uint32_t dimension = 0;
};

/// What tells encoders apart: XXH64 of model, settings and kind, 16 hex digits.
std::string fingerprint(const Encoder& encoder);

/// The fingerprints of the same model and settings, run by something else, and by what: a command,
/// any release of ONNX Runtime, OpenCV in earlier versions of etlc.
std::map<std::string, std::string> fingerprints_otherwise(const Encoder& encoder);

/// An image or a video.
struct Source {
    std::string path;  ///< relative to the spec
    std::string hash;  ///< of its bytes, 16 hex digits
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
    std::string etlc;                         ///< version that wrote it
    std::map<std::string, Encoder> encoders;  ///< by name
    /// By canonical text: "images(\"bay/*.png\") by dino".
    std::map<std::string, Entry> entries;
};

/// Where the embeddings of a spec are looked for: SPEC.embedded.npz beside SPEC.etl.
std::string default_path(const std::string& spec_path);

/// Failures are E04 and E10; their messages name the key, not the path: `data::in_file`
/// (data/files/file.hpp) adds it.
diag::Result<File> read(const std::string& path);
/// The same from memory.
diag::Result<File> parse(std::string_view bytes, const std::string& path);

/// The bytes of the archive: embedded.json, and float32 arrays "rows-1", "rows-2", ...
std::string write(const File& file);

/// What says of an episode which encoder made which of its inputs: the member embedded.json of its
/// .npz archive. Input -> fingerprint.
using Marks = std::map<std::string, std::string>;
std::string write_marks(const Marks& marks);
/// Of an episode; none where it has none, which only archives that `etlc embed` wrote do.
diag::Result<Marks> read_marks(const std::string& path);

}  // namespace etlc::embedded
