// The text of the programs around a class.
#pragma once

#include <string>
#include <vector>

#include "prove/prove.hpp"

namespace etlc::prove {

std::string constructor_arguments(const plan::Plan& plan);

/// Returns the program that drives the class on symbols. `truths`: of each atom, in a class of
/// truth values.
std::string program_text(const plan::Plan& plan, const Request& request,
                         const std::vector<Atom>& atoms, const std::vector<Truths>& truths);

/// Returns a source whose object has everything that the class needs.
std::string object_text(const plan::Plan& plan, const Request& request);

}  // namespace etlc::prove
