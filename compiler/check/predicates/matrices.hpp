// Matrices of float32 that a spec loads or spells out: target sets and weights.
// Takes: load(...) or a literal. Gives: rows, columns and values.
// Keeps true: rows and columns are at least 1; every value is finite in float32; a file is read
// once, and reported once.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ast/ast.hpp"
#include "check/model/inputs.hpp"

namespace etlc::check {

struct Context;

struct Matrix {
    std::uint32_t rows = 0;
    std::uint32_t columns = 0;
    /// A file's array of one dimension, or a literal [1, 2, 3]; rows is then 1.
    bool one_dimensional = false;
    std::vector<float> values;  ///< row-major
    std::string origin;         ///< "targets/goal_a.npy", "file.npz:key" or "literal"
    std::string path;           ///< of the file, relative to where etlc runs; empty for a literal
    std::string hash;
    std::vector<EncodedRows> encoded;  ///< where it was made of images
};

/// What files gave, by path and key, for those who check a spec again and again. It is used again
/// while the file has the same time and size.
struct KnownMatrix {
    std::filesystem::file_time_type time;
    std::uintmax_t size = 0;
    Matrix matrix;
};
using KnownMatrices = std::map<std::pair<std::string, std::string>, KnownMatrix>;

/// A path of the spec, relative to where etlc runs.
std::string beside_spec(const Context& context, const std::string& path);

std::optional<Matrix> read_matrix(Context& context, const ast::Load& load);
std::optional<Matrix> read_matrix(Context& context, const ast::MatrixLiteral& literal);
std::optional<Matrix> read_matrix(Context& context, const ast::VectorLiteral& literal);

/// Frames of a recording: samples of the embedding input whose name is the key.
std::optional<Matrix> read_frames(Context& context, const ast::Frames& frames);

/// The frames listed, or from the first to the last by the stride, in the order of the spec.
std::optional<std::vector<std::uint64_t>> frames_of(Context& context, const ast::Frames& frames);

}  // namespace etlc::check
