// The names of a spec: one namespace for constants, encoders, inputs, projections, targets,
// predicates, lets and monitors. Takes: declarations, in file order. Gives: what a name means, and
// what was never used. Keeps true: every declaration has an entity, also one that repeats a name; a
// name means its first declaration.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "ast/ast.hpp"
#include "check/model/model.hpp"

namespace etlc::check {

/// `unreadable`: parse/ saw a declaration of the name but could not read it; it fits wherever it is
/// used.
enum class NameKind : std::uint8_t {
    constant,
    encoder,
    input,
    projection,
    target,
    predicate,
    let,
    monitor,
    unreadable,
};
inline constexpr std::size_t kNameKinds = 9;

std::string_view word(NameKind kind);               ///< "input"
std::string_view word_with_article(NameKind kind);  ///< "an input"

struct Entity {
    std::string name;
    Span span;  ///< of the name where it is declared
    bool duplicate = false;
    bool broken = false;  ///< had an error: uses are accepted in silence
    bool used = false;
};

struct Reference {
    NameKind kind = NameKind::unreadable;
    Index index = 0;  ///< of the model's elements of that kind
};

class Scope {
public:
    /// Adds the next declaration of its kind. Returns the earlier declaration where the name is
    /// taken.
    const Entity* declare(NameKind kind, const ast::Name& name);

    const Reference* find(std::string_view name) const;
    Entity& entity(NameKind kind, Index index) {
        return entities_[static_cast<std::size_t>(kind)][index];
    }
    Entity& entity(const Reference& reference) { return entity(reference.kind, reference.index); }
    std::vector<Entity>& all(NameKind kind) { return entities_[static_cast<std::size_t>(kind)]; }

    /// The name among those of `kinds` that `name` was probably meant to be; empty where none is
    /// near, or where a spec full of unknown names would make the search long.
    std::string nearest(std::string_view name, const std::vector<NameKind>& kinds);

private:
    std::array<std::vector<Entity>, kNameKinds> entities_;
    std::unordered_map<std::string, Reference> names_;
    std::size_t comparisons_ = 0;
};

}  // namespace etlc::check
