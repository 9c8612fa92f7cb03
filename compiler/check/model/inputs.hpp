// What the monitor sees and what it is compared with: inputs, points made of them, target sets.
// Takes its form from check/predicates/ and check/points/. Keeps true: every index is in range, of
// the vectors of check::Model.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "check/numbers/range.hpp"
#include "source/source.hpp"

namespace etlc::check {

using source::Span;
using Index = std::uint32_t;
inline constexpr Index kNone = std::numeric_limits<Index>::max();

// ---- what the monitor sees ----------------------------------------------------------------------

enum class InputType : std::uint8_t { scalar, boolean, f32, f16, i8 };

/// What makes an embedding of an image: a model, and what is done to the image before.
struct Encoder {
    std::string name;
    std::string model;             ///< the file, as the spec names it
    std::vector<float> image;      ///< rows and columns that images are resized to; or empty
    std::vector<float> mean;       ///< of red, green, blue; or empty
    std::vector<float> deviation;  ///< the same
    std::string declaration;       ///< canonical text
    std::uint32_t dimension = 0;   ///< of the inputs by it; 0: there is none
    std::string fingerprint;       ///< embedded::fingerprint; empty: `etlc embed` has not been run
    /// Fingerprints of the same model run by something else, and by what.
    std::map<std::string, std::string> otherwise;
    Span span;
};

/// Images, or frames of a video, that a target is made of.
struct Encoded {
    std::string text;  ///< canonical, "images(\"bay/*.png\") by dino"
    Index encoder = 0;
    std::string path;  ///< of a file, a folder or a pattern, as the spec names it
    bool is_video = false;
    std::vector<std::uint64_t> frames;  ///< of a video, in the order of the rows
    Span span;
};

struct Input {
    std::string name;
    InputType type = InputType::scalar;
    std::uint32_t dimension = 1;  ///< of embeddings
    float scale = 1.0F;           ///< i8: value = scale x integer
    Range range;                  ///< scalars; a sample outside counts as missing
    bool has_range = false;
    /// At most so many missing samples in a row are replaced by the last present one.
    std::uint32_t hold = 0;
    std::optional<bool> missing;  ///< bool: what it counts as where it is missing
    Index encoder = kNone;        ///< of Model::encoders: what makes it of images
    Span span;

    bool is_embedding() const { return type != InputType::scalar && type != InputType::boolean; }
};

/// A linear map of points: P(z) = A (z - m).
struct Projection {
    std::string name;
    std::uint32_t rows = 0;       ///< R, the dimension of P(z)
    std::uint32_t dimension = 0;  ///< D, that of z
    std::vector<float> matrix;    ///< A: R x D, row-major, all finite; empty: not fitted yet
    std::vector<float> offset;    ///< m: D, all finite; empty: none
    std::string origin;           ///< "pca.npz:A", "literal" or "fitted", as in Target
    std::string path;      ///< of the file that the matrix was read from; empty for a literal
    std::string hash;      ///< content hash of shape and values
    Index fitted = kNone;  ///< of Model::fitted
    Span span;
};

/// What is measured: one embedding, a vector of scalars [px, py], or P(POINT).
struct Point {
    enum class Kind : std::uint8_t { embedding, scalars, projected };
    Kind kind = Kind::embedding;
    std::vector<Index> inputs;  ///< the embedding, or the scalars; of P(POINT) those of POINT
    std::uint32_t dimension = 0;
    Index projection = kNone;  ///< P
    Index inner = kNone;       ///< POINT, which stands before it in Model::points
    std::string text;          ///< canonical text: "Q(z)", "[px, py]"

    bool is_vector() const { return kind == Kind::scalars; }
    bool is_projected() const { return kind == Kind::projected; }
};

/// Rows of a target that are made of images, or of frames of a video, one after the other.
struct EncodedRows {
    Index encoded = 0;  ///< of Model::encoded
    std::uint32_t first = 0;
    std::uint32_t count = 0;
};

/// Z_target: rows x dimension float32, row-major, all finite.
struct Target {
    std::string name;
    std::uint32_t rows = 0;
    std::uint32_t dimension = 0;
    std::vector<float> values;  ///< empty: not fitted yet
    /// "targets/goal_a.npy", "file.npz:key" or "literal", as written in the spec.
    std::string origin;
    std::string path;                  ///< of a file it was read from; empty for a literal
    std::string hash;                  ///< content hash of shape and values, data::content_hash
    std::vector<EncodedRows> encoded;  ///< the rows that are of images
    /// The point in whose space the rows are, of Model::points; kNone: in that of the inputs.
    Index space = kNone;
    /// The declared target whose rows these are, projected into `space`; kNone: declared itself.
    Index source = kNone;
    Index fitted = kNone;  ///< of Model::fitted
    Span span;
};

}  // namespace etlc::check
