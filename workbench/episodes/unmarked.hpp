// Episodes that do not say which encoder made their embeddings.
// Takes: what was read of episodes, or where they lie. Gives: one warning for all of them (W1001).
// Keeps true: a spec without an encoder is not warned about.
#pragma once

#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "artifacts/embedded.hpp"
#include "episodes/recording.hpp"

namespace etlc::episodes {

/// Whether one of the inputs is by an encoder and the episode does not say by which. `marks`: what
/// it says.
bool is_unmarked(const check::Model& model, const std::vector<Index>& inputs,
                 const data::NamesInFile& names, const embedded::Marks& marks);

void warn_of_unmarked(const Identities& episodes, diag::Sink& sink);
/// Of episodes that have been read. `inputs`: those that the command asks them for.
void warn_of_unmarked(const check::Model& model, const std::vector<Index>& inputs,
                      const std::vector<std::string>& paths, const data::NamesInFile& names,
                      diag::Sink& sink);

}  // namespace etlc::episodes
