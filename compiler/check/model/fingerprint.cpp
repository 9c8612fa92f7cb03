#include "check/model/fingerprint.hpp"

#include <fmt/format.h>

#include "data/arrays/array.hpp"
#include "data/files/hash.hpp"

namespace etlc::check {

namespace {

std::uint64_t hash_of(const std::string& lines) {
    return lines.empty() ? 0 : data::xxh64(lines);
}

/// A line an encoder, a projection and a line a target set, as declared, and a line a distance with
/// weights: its name, and the hash of the numbers.
std::string data_lines(const Model& model) {
    std::string lines;
    for (const Encoder& encoder : model.encoders)
        lines += fmt::format("{} {}\n", encoder.name, encoder.fingerprint);
    for (const Projection& projection : model.projections)
        lines += fmt::format("{} {}\n", projection.name, projection.hash);
    for (const Target& target : model.targets)
        if (target.source == kNone) lines += fmt::format("{} {}\n", target.name, target.hash);
    for (const Distance& distance : model.distances)
        if (!distance.weights.empty())
            lines += fmt::format("{} {}\n", distance.text, weights_hash(distance));
    return lines;
}

/// A line a named predicate, and a line a monitor that is calibrated as a whole: its name, and the
/// shortest decimal number that reads back to the float32. Thresholds without a name stand in the
/// spec.
std::string threshold_lines(const Model& model) {
    std::string lines;
    for (const Predicate& predicate : model.predicates)
        if (!predicate.name.empty())
            lines += fmt::format("{} {}\n", predicate.name, predicate.threshold.value);
    for (const Monitor& monitor : model.monitors)
        if (monitor.calibration)
            lines += fmt::format("{} {}\n", monitor.name, monitor.calibration->threshold.value);
    return lines;
}

/// The bytes of the file, and a line for each constant that was set from outside.
std::string spec_text(const Model& model) {
    std::string text(model.file.text());
    for (const Constant& constant : model.constants)
        if (constant.is_set) text += fmt::format("--set {}={}\n", constant.name, constant.text);
    return text;
}

}  // namespace

std::string weights_hash(const Distance& distance) {
    return data::content_hash({distance.weights.size()}, distance.weights);
}

Fingerprint fingerprint(const Model& model) {
    return {data::xxh64(spec_text(model)), hash_of(data_lines(model)),
            hash_of(threshold_lines(model))};
}

}  // namespace etlc::check
