// Every field of a model, changed in turn.
// Takes: a model, or a part of it. Gives: a call after each change, which is then taken back. Keeps
// true: structs are taken apart into all their fields, so this does not compile with a field that
// nobody has thought of; what a changed index points to is there.
#pragma once

#include <functional>
#include <set>
#include <string>

#include "check/model/model.hpp"

namespace etlc::tests {

/// What is changed, and which of the changes were noticed.
class Changing {
public:
    /// `is_read`: whether anything is read otherwise now.
    using IsRead = std::function<bool()>;
    explicit Changing(IsRead is_read) : is_read_(std::move(is_read)) {}

    /// A struct of this name begins.
    void of(std::string name);
    /// The field is another now.
    void note(const std::string& name);
    /// Whether a field of this struct is read.
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
