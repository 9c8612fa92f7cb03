// drift NAME = of NAME, level = L: the scores of calibration, as the cells that the class bets on.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "artifacts/thresholds.hpp"
#include "check/context/context.hpp"
#include "check/guarantees/drift.hpp"
#include "check/numbers/decimal.hpp"
#include "data/files/hash.hpp"
#include "etlmon/temporal/shift.hpp"

namespace etlc::check {

namespace {

using diag::Code;

constexpr std::uint64_t kLeastScores = etlmon::kDriftCells - 1;  // a gap for each cell

/// Returns the level; empty after an error. Below 1e-9 an alarm would take longer than robots live.
std::string level_of(Context& c, const ast::Drift& written) {
    const bool is_alone = written.arguments.size() == 1 && written.arguments[0].key.text == "level";
    const auto* const bound =
        is_alone ? std::get_if<ast::Bound>(&written.arguments[0].value) : nullptr;
    const Decimal level =
        Decimal::parse(bound != nullptr && bound->unit.empty() ? bound->number.text : "0");
    if (level < Decimal::parse("1") && !(level < Decimal::parse("1e-9"))) return bound->number.text;
    c.report(Code::drift_level, is_alone ? ast::span_of(written.arguments[0].value) : written.span,
             "expected 'level = L' with a number L from 1e-9 to below 1, the probability of ever "
             "raising an alarm without reason");
    return {};
}

/// Sets what the drift watches; returns false after an error.
bool watch(Context& c, const ast::Drift& written, Drift& drift) {
    const Reference* const found =
        find(c, written.of, {NameKind::predicate, NameKind::monitor}, "a predicate or a monitor");
    if (found == nullptr || found->kind == NameKind::unreadable || c.scope.entity(*found).broken)
        return false;
    const auto refuse = [&](std::string_view why) {
        c.report(Code::drift_of, written.of.span,
                 fmt::format("'{}' {}; expected a predicate, or a monitor that is not sliding, "
                             "with 'calibrated(normal, alpha = A)'",
                             written.of.text, why))
            .note(c.scope.entity(*found).span,
                  fmt::format("'{}' is declared here", written.of.text));
        return false;
    };
    const Threshold* calibration = nullptr;
    if (found->kind == NameKind::predicate)
        calibration = &c.model.predicates[drift.predicate = found->index].threshold;
    if (found->kind == NameKind::monitor) {
        const Monitor& monitor = c.model.monitors[drift.monitor = found->index];
        if (monitor.sliding)
            return refuse("is sliding, so its score is known only after calls of finish()");
        if (monitor.calibration) calibration = &*monitor.calibration;
    }
    if (calibration != nullptr && calibration->origin == ThresholdOrigin::normal) return true;
    return refuse("is not calibrated on normal episodes, so new ones have no score");
}

}  // namespace

std::vector<Drawn> draw(const std::vector<float>& scores) {
    std::string text;
    for (const float score : scores) text += fmt::format("{} ", score);
    const std::uint64_t hash = data::xxh64(text);
    std::vector<Drawn> drawn;
    for (const float score : scores)
        drawn.push_back({score, static_cast<std::uint32_t>(
                                    data::xxh64(fmt::format("{}", drawn.size()), hash))});
    std::sort(drawn.begin(), drawn.end());
    return drawn;
}

etlmon::DriftCells drift_cells(const std::vector<Drawn>& drawn, double level) {
    etlmon::DriftCells cells{};
    std::uint64_t before = 0;
    for (std::uint32_t i = 0; i < etlmon::kDriftCells; ++i) {
        const std::uint64_t end = (drawn.size() + 1) * (i + 1) / etlmon::kDriftCells;
        cells.gaps[i] = static_cast<std::uint32_t>(end - before);
        before = end;
        if (i + 1 == etlmon::kDriftCells) break;
        cells.ends[i] = drawn[end - 1].first;
        cells.draws[i] = drawn[end - 1].second;
    }
    cells.limit = round_up(1 / level);
    const std::string text =
        fmt::format("{} {} {} {}", fmt::join(cells.ends, " "), fmt::join(cells.draws, " "),
                    fmt::join(cells.gaps, " "), cells.limit);
    cells.id = static_cast<std::uint32_t>(data::xxh64(text)) | 1U;
    return cells;
}

void check_drifts(Context& c) {
    for_each_declaration<ast::Drift>(c.spec, [&](const ast::Drift& written, Index index) {
        Drift drift;
        drift.name = written.name.text;
        drift.span = written.span;
        drift.level = level_of(c, written);
        if (!watch(c, written, drift) || drift.level.empty())
            c.scope.entity(NameKind::drift, index).broken = true;
        c.model.drifts.push_back(std::move(drift));
    });
}

void take_drift(Context& c, Drift& drift, const thresholds::File& file) {
    const bool of_monitor = drift.monitor != kNone;
    const auto& entries = of_monitor ? file.monitors : file.predicates;
    const std::string& name = of_monitor ? c.model.monitors[drift.monitor].name
                                         : c.model.predicates[drift.predicate].name;
    const auto found = entries.find(name);
    if (found == entries.end()) return;  // that has been reported
    const thresholds::Entry& entry = found->second;
    const auto refuse = [&](Code code, std::string message, std::string advice) {
        c.sink.report(data::in_file({code, std::move(message)}, file.path))
            .note(drift.span, "it is needed here")
            .note(std::move(advice));
    };
    const std::string place = (of_monitor ? "monitors." : "predicates.") + name;
    if (entry.measured.empty())
        return refuse(Code::drift_without_scores,
                      fmt::format("'{}' has no 'measured', the scores of the demonstrations as the "
                                  "monitor measures them",
                                  place),
                      "an earlier version of etlc wrote the file: calibrate again with 'etlc "
                      "calibrate'");
    if (entry.measured.size() < kLeastScores)
        return refuse(Code::drift_too_few_scores,
                      fmt::format("'{}' has {}; a drift needs at least {}", place,
                                  diag::counted(entry.measured.size(), "score"), kLeastScores),
                      "calibrate with more demonstrations");
    const auto& threshold = of_monitor ? *c.model.monitors[drift.monitor].calibration
                                       : c.model.predicates[drift.predicate].threshold;
    if (threshold.by_group)
        return refuse(Code::drift_of,
                      fmt::format("the scores of '{}' are those of groups of episodes, with which "
                                  "single episodes cannot be compared",
                                  name),
                      "calibrate on episodes without groups, or leave the drift out");
    std::vector<float> scores;
    for (const double score : entry.measured) {
        const auto measured = static_cast<float>(score);
        if (of_monitor)
            scores.push_back(0.0F - etlmon::float_of(etlmon::shifted(etlmon::key_of(measured),
                                                                     threshold.value)));
        else
            scores.push_back(c.model.predicates[drift.predicate].upper_bound() ? measured
                                                                               : 0.0F - measured);
    }
    drift.cells = drift_cells(draw(scores), to_double(drift.level));
}

}  // namespace etlc::check
