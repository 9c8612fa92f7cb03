// A compiled spec with what the interface says about it. It does not change, so sessions that were
// copied from one another share it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "compile.hpp"
#include "diag/diag.hpp"
#include "execute/tables.hpp"
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

}  // namespace etlc::library
