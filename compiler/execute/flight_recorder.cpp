#include "execute/flight_recorder.hpp"

#include "check/model/fingerprint.hpp"

namespace etlc::execute {

using namespace plan;

namespace {

RecorderSizes sizes_of(const Plan& plan, const RecorderColumns& columns) {
    const Recorder& recorder = *plan.recorder;
    return {columns.figures,  static_cast<std::uint32_t>(columns.bools.size()),
            columns.monitors, recorder.before,
            recorder.after,   recorder.incidents};
}

etlmon::IncidentOrigin origin_of(const Plan& plan) {
    const check::Fingerprint made_from = check::fingerprint(*plan.model);
    return {made_from.spec, made_from.data, made_from.thresholds, columns_hash(plan)};
}

}  // namespace

FlightRecorder::FlightRecorder(const Plan& plan)
    : plan_(plan),
      columns_(recorder_columns(plan)),
      origin_(origin_of(plan)),
      unasked_(sizes_of(plan, columns_)),
      row_(unasked_),
      statuses_(plan.monitors.size()),
      recorder_(RecorderStorage(sizes_of(plan, columns_))) {
    bytes_.reserve(incident_bytes(plan));
}

void FlightRecorder::step(const Evaluator& evaluator,
                          const std::vector<etlmon::Verdict>& verdicts) {
    fill(evaluator);
    // A monitor that moves to the next step may raise a new alarm.
    for (std::size_t m = 0; m < plan_.monitors.size(); ++m)
        if (plan_.monitors[m].restarts == check::Restarts::when_final && verdicts[m].final())
            restart(m);
    record(row_, verdicts);
}

void FlightRecorder::finish(const std::vector<etlmon::Verdict>& verdicts) {
    if (plan_.has_sliding) record(unasked_, verdicts);  // prefix monitors do not change any more
}

void FlightRecorder::fill(const Evaluator& evaluator) {
    for (const RecorderColumns::OfPredicate& column : columns_.predicates) {
        std::uint32_t at = column.figure;
        row_.figure(at++, evaluator.distance(column.predicate));
        for (const Index d : column.nearest)
            row_.nearest(at++, evaluator.nearest(column.predicate, d));
        if (column.threshold) row_.figure(at, evaluator.threshold(column.predicate));
    }
    for (std::uint32_t b = 0; b < columns_.bools.size(); ++b) {
        const float* const value = evaluator.input(columns_.bools[b]);
        row_.flag(b, value == nullptr ? etlmon::Flag() : etlmon::Flag(*value != 0));
    }
}

void FlightRecorder::record(const RecorderRow& row, const std::vector<etlmon::Verdict>& verdicts) {
    for (std::size_t m = 0; m < statuses_.size(); ++m) statuses_[m] = verdicts[m].status;
    recorder_.record(row, statuses_);
}

const std::vector<std::uint8_t>& FlightRecorder::write(std::uint32_t incident) {
    bytes_.clear();
    recorder_.write(incident, origin_, [this](const std::uint8_t* bytes, std::size_t size) {
        bytes_.insert(bytes_.end(), bytes, bytes + size);
    });
    return bytes_;
}

}  // namespace etlc::execute
