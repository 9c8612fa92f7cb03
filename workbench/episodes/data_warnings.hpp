// Warnings about episodes and their labels, the same wherever these are read.
// Keeps true: episodes that do not say which encoder made their embeddings cause one warning
// (W1001); a spec without an encoder causes none; the direction of labels is doubted where the
// whole interval of the AUROC says so.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "embedded/embedded.hpp"
#include "episodes/ranking/auroc.hpp"
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

/// How many frames the labels of a predicate call positive and negative.
struct Labels {
    std::uint64_t positives = 0;
    std::uint64_t negatives = 0;
};

/// Whether there was something to warn of.
bool warn_of_labels(const check::Predicate& predicate, Labels labels,
                    const std::optional<Auroc>& auroc, diag::Sink& sink);

/// A warning of the data that is about a place in the spec, of which nothing is wrong.
diag::Diagnostic& warn_of_data(diag::Code code, std::string message, source::Span about,
                               diag::Sink& sink);

}  // namespace etlc::episodes
