// Names, brackets and statements in the text of a generated class.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace etlc::prove::code {

/// A name in a text. Each verdict is one: "answers_.stay".
struct Found {
    std::string name;
    std::size_t begin;
    std::size_t end;
};

std::string without_comments(std::string_view text);
/// Returns the place of the bracket that closes the one at `open`. Throws Unreadable.
std::size_t closing(std::string_view text, std::size_t open);
std::size_t skip_space(std::string_view text, std::size_t at);
/// Returns the name that begins here; empty where none does.
std::string_view name_at(std::string_view text, std::size_t at);
/// Leaves out fields, and names of a namespace.
std::vector<Found> names_in(std::string_view text);
/// Whether a statement may write what a name in it means.
bool is_written(std::string_view text, const Found& found);
/// Whether a statement declares a reference, which is then another name for what it refers to.
bool makes_reference(std::string_view text);

}  // namespace etlc::prove::code
