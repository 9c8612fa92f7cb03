// Warnings about episodes and their labels, shared by all commands that read these. Episodes that
// do not name the encoder of their embeddings cause one warning a call (W1001), and none without an
// encoder in the spec. Labels count as inverted only where the whole interval of the AUROC lies
// below 0.5.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "artifacts/embedded.hpp"
#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "episodes/ranking/auroc.hpp"
#include "episodes/recording.hpp"

namespace etlc::episodes {

/// Returns whether an input needs an encoder that the episode's marks do not name.
bool is_unmarked(const check::Model& model, const std::vector<Index>& inputs,
                 const recordings::NamesInFile& names, const embedded::Marks& marks);

void warn_of_unmarked(const Identities& episodes, diag::Sink& sink);
/// Reads the marks of the episodes. `inputs`: those that the command reads.
void warn_of_unmarked(const check::Model& model, const std::vector<Index>& inputs,
                      const std::vector<std::string>& paths, const recordings::NamesInFile& names,
                      diag::Sink& sink);

/// The numbers of frames labelled true and false.
struct Labels {
    std::uint64_t positives = 0;
    std::uint64_t negatives = 0;
};

/// Warns of one-sided or inverted labels; returns whether it did.
bool warn_of_labels(const check::Predicate& predicate, Labels labels,
                    const std::optional<Auroc>& auroc, diag::Sink& sink);

/// Reports a warning about the data that points into the spec.
diag::Diagnostic& warn_of_data(diag::Code code, std::string message, source::Span about,
                               diag::Sink& sink);

}  // namespace etlc::episodes
