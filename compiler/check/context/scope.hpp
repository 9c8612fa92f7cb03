// The names of a spec, in one namespace for all kinds of declarations. Every declaration has an
// entity, even if it repeats a name; a name means its first declaration.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "ast/ast.hpp"
#include "check/model/model.hpp"

namespace etlc::check {

/// `unreadable`: parse/ saw a declaration of the name but could not read it; the name is accepted
/// everywhere.
enum class NameKind : std::uint8_t {
    constant,
    encoder,
    input,
    projection,
    target,
    predicate,
    let,
    monitor,
    drift,
    unreadable,
};
inline constexpr std::size_t kNameKinds = 10;

std::string_view word(NameKind kind);               ///< "input"
std::string_view word_with_article(NameKind kind);  ///< "an input"

struct Entity {
    std::string name;
    Span span;  ///< of the declared name
    bool duplicate = false;
    bool broken = false;  ///< has an error; uses are accepted silently
    bool used = false;
};

struct Reference {
    NameKind kind = NameKind::unreadable;
    Index index = 0;  ///< in the model's elements of that kind
};

class Scope {
public:
    /// Adds the next declaration of its kind. Returns the earlier declaration if the name is taken.
    const Entity* declare(NameKind kind, const ast::Name& name);

    const Reference* find(std::string_view name) const;
    Entity& entity(NameKind kind, Index index) {
        return entities_[static_cast<std::size_t>(kind)][index];
    }
    Entity& entity(const Reference& reference) { return entity(reference.kind, reference.index); }
    std::vector<Entity>& all(NameKind kind) { return entities_[static_cast<std::size_t>(kind)]; }

    /// Returns the name of one of `kinds` that is most similar to `name`; empty if none is similar,
    /// or if a spec full of unknown names would make the search long.
    std::string nearest(std::string_view name, std::initializer_list<NameKind> kinds);

private:
    struct Hash : std::hash<std::string_view> {
        using is_transparent = void;
    };

    std::array<std::vector<Entity>, kNameKinds> entities_;
    std::unordered_map<std::string, Reference, Hash, std::equal_to<>> names_;
    std::size_t comparisons_ = 0;
};

}  // namespace etlc::check
