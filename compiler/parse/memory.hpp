// What was read of a text, for editors: of its next state only what changed is read.
#pragma once

#include <memory>
#include <vector>

#include "ast/ast.hpp"
#include "diag/diag.hpp"
#include "parse/words.hpp"
#include "source/source.hpp"

namespace etlc::parse {

class Memory {
public:
    Memory();
    Memory(Memory&&) noexcept;
    Memory& operator=(Memory&&) noexcept;
    ~Memory();

    /// Returns and reports what parse() does.
    ast::Spec parse(const source::File& file, diag::Sink& sink);
    /// Returns what words_of() does.
    std::vector<Word> words_of(const source::File& file);

private:
    struct Content;
    std::unique_ptr<Content> content_;
};

}  // namespace etlc::parse
