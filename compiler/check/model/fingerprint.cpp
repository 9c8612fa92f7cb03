#include "check/model/fingerprint.hpp"

#include <fmt/format.h>

#include "data/arrays/array.hpp"
#include "data/files/hash.hpp"

namespace etlc::check {

namespace {

std::uint64_t hash_of(const std::string& lines) {
    return lines.empty() ? 0 : data::xxh64(lines);
}

/// Returns the name and hash of each encoder, projection, declared target set and distance with
/// weights, one per line.
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

/// Returns the name of each named predicate and calibrated monitor, with the shortest decimal that
/// reads back to its float32 threshold, and of a second one, one per line; of a monitor with a
/// calibrated duration that in steps. Unnamed thresholds are
/// part of the spec.
std::string threshold_lines(const Model& model) {
    std::string lines;
    const auto add = [&](const std::string& name, const Threshold& threshold) {
        lines += fmt::format("{} {}", name, threshold.value);
        lines += threshold.inner ? fmt::format(" {}\n", *threshold.inner) : "\n";
    };
    for (const Predicate& predicate : model.predicates)
        if (!predicate.name.empty()) add(predicate.name, predicate.threshold);
    for (const Monitor& monitor : model.monitors) {
        if (monitor.calibration) add(monitor.name, *monitor.calibration);
        if (monitor.duration)
            lines += fmt::format("{} {}\n", monitor.name, monitor.duration->steps);
    }
    return lines;
}

/// Returns the bytes of the file, and a line for each constant set by --set.
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
