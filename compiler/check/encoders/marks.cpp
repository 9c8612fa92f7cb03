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
    return diag::Failure{
        diag::Code::other_encoder,
        fmt::format("'{}' is by the encoder {}; expected {}, which is '{}' of the spec", input.name,
                    mark->second, encoder.fingerprint, encoder.name)};
}

}  // namespace etlc::check
