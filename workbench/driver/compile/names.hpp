// `--map NAME=OTHER`: what an input of the spec, or the labels truth.NAME, are called in the files.
// Takes: the words of the call. Gives: names in the file by names of the spec. Keeps true: each
// name stands once.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "data/recordings/open.hpp"
#include "diag/diag.hpp"

namespace etlc::driver {

/// Nothing where a word is not NAME=OTHER, or maps a name again: `why` then says so.
std::optional<data::NamesInFile> parse_names(const std::vector<std::string>& words,
                                             std::string& why);

/// Reports the names that no spec has, E0804; false where there are any.
bool check_names(const std::vector<const check::Model*>& models, const data::NamesInFile& names,
                 diag::Sink& sink);

}  // namespace etlc::driver
