// A compiled spec with what the interface says about it. It does not change, so sessions that were
// copied from one another share it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "compile.hpp"
#include "diag/diag.hpp"
#include "execute/inputs.hpp"
#include "execute/tables.hpp"
#include "library/etlc.h"
#include "source/source.hpp"

namespace etlc::library {

using check::Index;

class Program {
public:
    /// Takes the compiled `file` and its findings.
    Program(source::File file, Compiled compiled, const diag::Sink& sink);
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    const plan::Plan& plan() const { return compiled_.plan; }
    const check::Model& model() const { return *compiled_.model; }
    const std::shared_ptr<const execute::Tables>& tables() const { return tables_; }
    const std::string& warnings() const { return warnings_; }
    const std::string& formula(std::size_t monitor) const { return formulas_[monitor]; }
    const std::string& predicate_name(Index predicate) const { return names_[predicate]; }
    const std::string& predicate_text(Index predicate) const { return texts_[predicate]; }
    bool is_used(Index input) const { return is_used_[input]; }
    bool is_measured(Index predicate) const { return is_measured_[predicate]; }

private:
    source::File file_;
    Compiled compiled_;
    std::shared_ptr<const execute::Tables> tables_;
    std::string warnings_;
    std::vector<std::string> formulas_;  ///< per monitor of the plan
    std::vector<std::string> names_;     ///< per predicate of the model
    std::vector<std::string> texts_;
    std::vector<bool> is_used_;      ///< per input
    std::vector<bool> is_measured_;  ///< per predicate
};

// Samples in the memory of the caller, and how the evaluator gets them.

/// Returns the type of an input's elements.
inline std::uint32_t type_of(const check::Input& input) {
    switch (input.type) {
        case check::InputType::boolean: return ETLC_BOOL;
        case check::InputType::f16: return ETLC_F16;
        case check::InputType::i8: return ETLC_I8;
        case check::InputType::scalar:
        case check::InputType::f32: break;
    }
    return ETLC_F32;
}

/// Returns a column as the only row of a grid.
inline etlc_grid grid_of(const etlc_column& column) {
    return {column.data, column.present, 0, column.stride, column.count, column.type};
}
/// Returns a sample; null where it is missing.
inline const void* at(const etlc_grid& grid, std::uint64_t steps, std::uint64_t row,
                      std::uint64_t step) {
    if (grid.data == nullptr || (grid.present != nullptr && grid.present[row * steps + step] == 0))
        return nullptr;
    return static_cast<const char*>(grid.data) + static_cast<std::int64_t>(row) * grid.stride +
           static_cast<std::int64_t>(step) * grid.step_stride;
}

/// Converts elements to float32 as the generated class does.
void widen(const check::Input& input, const void* data, float* to);

/// Puts a sample, or that it is missing, where the evaluator reads it.
void take(const check::Input& input, const void* data, execute::Sample& sample);

}  // namespace etlc::library
