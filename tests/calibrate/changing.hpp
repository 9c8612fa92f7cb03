// Changes every field of a model in turn.
// Takes: a model, or a part of it. Gives: a call after each change, which is then undone. Keeps
// true: structs are decomposed into all their fields, so a forgotten field does not compile; a
// changed index stays valid.
#pragma once

#include <functional>
#include <set>
#include <string>

#include "check/model/model.hpp"

namespace etlc::tests {

/// The changes, and which of them were noticed.
class Changing {
public:
    /// `is_read`: whether the text of reads changed.
    using IsRead = std::function<bool()>;
    explicit Changing(IsRead is_read) : is_read_(std::move(is_read)) {}

    /// Enters a struct with this name.
    void of(std::string name);
    /// Records that the field has changed.
    void note(const std::string& name);
    /// Returns whether a field of this struct is read.
    bool some() const { return some_; }

    std::set<std::string> read, all;  ///< "Input.hold"

private:
    IsRead is_read_;
    std::string struct_;
    bool some_ = false;
};

void visit(check::Model& model, Changing& changing);
void visit(check::Model& model, check::Input& input, Changing& changing);
void visit(check::Model& model, check::Distance& distance, Changing& changing);
void visit(check::Model& model, check::Predicate& predicate, Changing& changing);
void visit(check::Model& model, check::Truth& truth, Changing& changing);

}  // namespace etlc::tests
