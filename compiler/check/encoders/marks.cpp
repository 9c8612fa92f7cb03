#include "check/encoders/marks.hpp"

#include <fmt/format.h>

namespace etlc::check {

std::optional<diag::Failure> other_encoder(const Model& model, const Input& input,
                                           const std::string& array, const embedded::Marks& marks) {
    if (input.encoder == kNone) return std::nullopt;
    const Encoder& encoder = model.encoders[input.encoder];
    const auto mark = marks.find(array);
    const bool is_known = mark != marks.end() && !encoder.fingerprint.empty();
    if (!is_known || mark->second == encoder.fingerprint) return std::nullopt;
    const auto same_model = encoder.otherwise.find(mark->second);
    const std::string run_by = same_model == encoder.otherwise.end()
                                   ? ""
                                   : fmt::format(", the same model run by {}", same_model->second);
    return diag::Failure{
        diag::Code::other_encoder,
        fmt::format("'{}' is by the encoder {}{}; expected {}, which is '{}' of the spec",
                    input.name, mark->second, run_by, encoder.fingerprint, encoder.name)};
}

bool is_unmarked(const Input& input, const std::string& array, const embedded::Marks& marks) {
    return input.encoder != kNone && !marks.contains(array);
}

void explain_unmarked(diag::Diagnostic& warning) {
    warning.note("embeddings by another encoder than the spec's would be taken in the same way");
    warning.note(
        "an episode of `etlc embed` says it in embedded.json, a member of its .npz file that "
        "numpy.savez does not write: copy it, as docs/recordings.md shows under Fingerprints; "
        "recordings of other kinds cannot say it");
}

}  // namespace etlc::check
