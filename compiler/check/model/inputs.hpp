// Inputs, points and target sets of the model. Every index is in range.
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
/// Limit on the dimension of a point: 4 MiB in float32.
inline constexpr std::uint32_t kMaxDimension = 1U << 20U;

// ---- what the monitor sees ----------------------------------------------------------------------

enum class InputType : std::uint8_t { scalar, boolean, f32, f16, i8 };

/// A model that makes embeddings from images, and its preprocessing.
struct Encoder {
    std::string name;
    std::string model;             ///< the file as named in the spec
    std::string preprocessor;      ///< the same; or empty
    std::vector<float> image;      ///< rows and columns of what the model sees; or empty
    std::vector<float> mean;       ///< red, green, blue; or empty
    std::vector<float> deviation;  ///< red, green, blue; or empty
    std::string filter;            ///< "bilinear" or "bicubic", as in Pillow; or empty
    std::vector<float> resize;     ///< with a filter: shorter side, or rows and columns; or empty
    std::string flip;              ///< "horizontal", "vertical" or "both"; or empty
    std::string channels;          ///< "rgb" or "bgr"; or empty
    std::string margins;           ///< halves of them are rounded "even" or "down"; or empty
    std::string output;            ///< that is the embedding; empty: the only one
    std::string pool;              ///< "cls" or "mean": how tokens become one vector; or empty
    std::string declaration;       ///< canonical text
    std::uint32_t dimension = 0;   ///< of its inputs; 0 if there are none
    std::string fingerprint;       ///< embedded::fingerprint; empty before `etlc embed`
    /// Its embeddings of the reference frames, `dimension` elements each; empty before `etlc
    /// embed`.
    std::vector<float> references;
    /// Fingerprints of the same model in other runtimes, with the names of these.
    std::map<std::string, std::string> otherwise;
    Span span;
};

/// Images, or frames of a video, in a target.
struct Encoded {
    std::string text;  ///< canonical, "images(\"bay/*.png\") by dino"
    Index encoder = 0;
    std::string path;  ///< a file, folder or pattern as named in the spec
    bool is_video = false;
    std::vector<std::uint64_t> frames;  ///< of a video, in the order of the rows
    Span span;
};

struct Input {
    std::string name;
    InputType type = InputType::scalar;
    std::uint32_t dimension = 1;  ///< of embeddings
    float scale = 1.0F;           ///< value = scale x integer, for i8
    Range range;                  ///< of scalars; samples outside count as missing
    bool has_range = false;
    /// Number of successive missing samples that the last present one replaces.
    std::uint32_t hold = 0;
    std::optional<bool> missing;  ///< value of missing samples of a bool
    /// Number of equal samples in a row that count; later ones are missing. 0: all count.
    std::uint32_t stale_after = 0;
    Index encoder = kNone;  ///< makes it from images; in Model::encoders
    Span span;

    bool is_embedding() const { return type != InputType::scalar && type != InputType::boolean; }
    /// Returns whether a step uses earlier samples, so that every sample has to be looked at.
    bool has_state() const { return hold > 0 || stale_after > 0; }
};

/// A linear map of points: P(z) = A (z - m).
struct Projection {
    std::string name;
    std::uint32_t rows = 0;       ///< R, the dimension of P(z)
    std::uint32_t dimension = 0;  ///< D, the dimension of z
    std::vector<float> matrix;    ///< A: R x D, row-major, all finite; empty before fitting
    std::vector<float> offset;    ///< m: D, all finite; or empty
    std::string origin;           ///< "pca.npz:A", "literal" or "fitted", as in Target
    std::string path;             ///< of the matrix file; empty for a literal
    std::string hash;             ///< content hash of shape and values
    Index fitted = kNone;         ///< in Model::fitted
    Span span;
};

/// A point to measure from: an embedding, a vector of scalars [px, py], P(POINT), POINT as it was
/// `steps` ago, or several points put together, [z, z@5]. What is delayed is none of the last two.
struct Point {
    enum class Kind : std::uint8_t { embedding, scalars, projected, delayed, joined };
    Kind kind = Kind::embedding;
    std::vector<Index> inputs;  ///< all that it is made of, in order
    std::uint32_t dimension = 0;
    Index projection = kNone;  ///< P
    Index inner = kNone;       ///< POINT, which precedes it in Model::points
    std::uint32_t steps = 0;   ///< delayed: at least 1
    std::vector<Index> parts;  ///< joined: at least two, which precede it in Model::points
    std::string text;          ///< canonical text: "Q(z)", "[px, py]", "z@90"

    bool is_vector() const { return kind == Kind::scalars; }
    bool is_projected() const { return kind == Kind::projected; }
    bool is_delayed() const { return kind == Kind::delayed; }
    bool is_joined() const { return kind == Kind::joined; }
};

/// Rows of a target that were made from images or from frames of a video.
struct EncodedRows {
    Index encoded = 0;  ///< in Model::encoded
    std::uint32_t first = 0;
    std::uint32_t count = 0;
};

/// Z_target: rows x dimension float32, row-major, all finite.
struct Target {
    std::string name;
    std::uint32_t rows = 0;
    std::uint32_t dimension = 0;
    std::vector<float> values;  ///< empty before fitting
    /// "targets/goal_a.npy", "file.npz:key" or "literal".
    std::string origin;
    std::string path;                  ///< of the file; empty for a literal
    std::string hash;                  ///< data::content_hash of shape and values
    std::vector<EncodedRows> encoded;  ///< rows made from images
    /// The point whose space contains the rows, in Model::points; kNone: the space of the inputs.
    Index space = kNone;
    /// The declared target whose rows were projected into `space`; kNone for declared targets.
    Index source = kNone;
    Index fitted = kNone;  ///< in Model::fitted
    Span span;
};

}  // namespace etlc::check
