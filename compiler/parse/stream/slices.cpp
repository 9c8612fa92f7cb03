#include "parse/stream/slices.hpp"

#include <algorithm>

#include "EtlLexer.h"

namespace etlc::parse {

using grammar::EtlLexer;

namespace {

/// Whether a declaration begins at token `i`. Its first words decide, since a declaration word
/// alone may be a reserved word mistaken for a name.
bool begins_declaration(const Tokens& tokens, std::size_t i) {
    const auto type = [&tokens](std::size_t k) {
        return k < tokens.size() ? tokens[k]->getType() : Token::EOF;
    };
    const bool name_follows = i + 1 < tokens.size() && is_name(*tokens[i + 1]);
    switch (type(i)) {
        case EtlLexer::SPEC: return name_follows && type(i + 2) == EtlLexer::SEMICOLON;
        case EtlLexer::RATE:
        case EtlLexer::PERIOD: return type(i + 1) == EtlLexer::NUMBER || name_follows;
        case EtlLexer::INPUT:
            return name_follows &&
                   (type(i + 2) == EtlLexer::COMMA || type(i + 2) == EtlLexer::COLON);
        case EtlLexer::SLIDING:
        case EtlLexer::RESTARTABLE:
        case EtlLexer::REPEATING: return type(i + 1) == EtlLexer::MONITOR;
        case EtlLexer::PROJECTION:
        case EtlLexer::ENCODER:
        case EtlLexer::CONST:
        case EtlLexer::TARGET:
        case EtlLexer::PREDICATE:
        case EtlLexer::TRUTH:
        case EtlLexer::LET:
        case EtlLexer::MONITOR: return name_follows && type(i + 2) == EtlLexer::ASSIGN;
        default: return false;
    }
}

}  // namespace

std::vector<Slice> slices_of(const Tokens& tokens) {
    std::vector<Slice> slices;
    std::size_t begin = 0;
    const std::size_t last = tokens.size() - 1;  // EOF
    for (std::size_t i = 0; i < last; ++i) {
        const bool of_a_kind = i == begin + 1 && tokens[i]->getType() == EtlLexer::MONITOR &&
                               begins_declaration(tokens, begin);
        if (i > begin && !of_a_kind && begins_declaration(tokens, i)) {
            slices.push_back({begin, i});
            begin = i;
        }
        const auto is_semicolon = [&tokens](std::size_t k) {
            return tokens[k]->getType() == EtlLexer::SEMICOLON;
        };
        // A run of stray ';' is one slice and one error.
        if (is_semicolon(begin) && is_semicolon(i) && is_semicolon(i + 1)) continue;
        if (is_semicolon(i)) {
            slices.push_back({begin, i + 1});
            begin = i + 1;
        }
    }
    if (begin < last) slices.push_back({begin, last});
    return slices;
}

SliceStream::SliceStream(const Tokens& tokens, Slice slice)
    : tokens_(tokens), slice_(slice), end_(Token::EOF) {
    end_.setStartIndex(tokens[slice.end]->getStartIndex());
    end_.setStopIndex(tokens[slice.end]->getStartIndex());
    end_.setTokenIndex(slice.end - slice.begin);
}

Token* SliceStream::LT(ssize_t k) {
    if (k == 0) return nullptr;
    const ssize_t at = static_cast<ssize_t>(at_) + (k > 0 ? k - 1 : k);
    return at < 0 ? nullptr : get(static_cast<std::size_t>(at));
}

Token* SliceStream::get(std::size_t index) const {
    if (index >= slice_.end - slice_.begin) return const_cast<antlr4::CommonToken*>(&end_);
    return tokens_[slice_.begin + index].get();
}

void SliceStream::consume() {
    if (at_ < size()) ++at_;
}

void SliceStream::seek(std::size_t index) {
    at_ = std::min(index, size());
}

}  // namespace etlc::parse
