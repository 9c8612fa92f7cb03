#include "check/context/scope.hpp"

#include "diag/diag.hpp"

namespace etlc::check {

namespace {

struct Words {
    std::string_view plain;
    std::string_view with_article;
};

constexpr std::array<Words, kNameKinds> kWords{{
    {"const", "a constant"},
    {"encoder", "an encoder"},
    {"input", "an input"},
    {"projection", "a projection"},
    {"target", "a target"},
    {"predicate", "a predicate"},
    {"let", "a let"},
    {"monitor", "a monitor"},
    {"drift", "a drift"},
    {"declaration", "a declaration"},
}};

/// Limit on the comparisons in all searches for similar names.
constexpr std::size_t kMaxComparisons = 1'000'000;

}  // namespace

std::string_view word(NameKind kind) {
    return kWords[static_cast<std::size_t>(kind)].plain;
}

std::string_view word_with_article(NameKind kind) {
    return kWords[static_cast<std::size_t>(kind)].with_article;
}

const Entity* Scope::declare(NameKind kind, const ast::Name& name) {
    std::vector<Entity>& entities = all(kind);
    entities.push_back({name.text, name.span});
    const auto [at, is_new] =
        names_.try_emplace(name.text, Reference{kind, static_cast<Index>(entities.size() - 1)});
    if (is_new) return nullptr;
    entities.back().duplicate = true;
    return &entity(at->second);
}

const Reference* Scope::find(std::string_view name) const {
    const auto found = names_.find(name);
    return found == names_.end() ? nullptr : &found->second;
}

std::string Scope::nearest(std::string_view name, std::initializer_list<NameKind> kinds) {
    std::vector<std::string> candidates;
    for (const NameKind kind : kinds)
        for (const Entity& entity : all(kind)) candidates.push_back(entity.name);
    comparisons_ += candidates.size();
    if (comparisons_ > kMaxComparisons) return {};
    return diag::nearest_name(name, candidates).value_or("");
}

}  // namespace etlc::check
