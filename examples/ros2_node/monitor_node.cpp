#include "monitor_node.hpp"

#include <algorithm>
#include <cstdio>

namespace patrol_node {

namespace {

std::string text(float x) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.6g", static_cast<double>(x));
    return digits;
}

/// The text for an operator; only an alarm is an error.
Status status_of(const char* monitor, const etlmon::Verdict& verdict) {
    Status status{Level::ok, std::string("patrol: ") + monitor, "no verdict yet", {}};
    if (!verdict.decided()) return status;
    if (verdict.alarm()) {
        status.level = Level::error;
        status.message = "violated for good";
    } else if (verdict.fulfilled()) {
        status.message = "satisfied for good";
    } else if (verdict.unknown()) {
        status.level = Level::warn;
        status.message = "unknown: an embedding is missing";
    } else {
        status.message = verdict.satisfied() ? "satisfied so far" : "not satisfied yet";
    }
    status.values = {{"robustness", text(verdict.robustness)},
                     {"lower", text(verdict.lower)},
                     {"upper", text(verdict.upper)}};
    return status;
}

}  // namespace

void MonitorNode::take(const float* elements, std::size_t count) {
    if (count != kDimension) {
        ++refused_;
        refused_size_ = count;
        return;
    }
    std::copy(elements, elements + count, newest_.begin());
    refused_size_ = 0;
    if (is_new_) ++replaced_;
    is_new_ = true;
    ++taken_;
}

void MonitorNode::take_references(const float* elements, std::size_t count) {
    constexpr std::uint32_t kFrames = patrol::Monitor::kReferenceFrames;
    encoder_.level = Level::error;
    encoder_.values.clear();
    if (count != kFrames * kDimension) {
        encoder_.message = "shows " + std::to_string(count) + " elements for the " +
                           std::to_string(kFrames) + " reference frames, expected " +
                           std::to_string(kFrames * kDimension);
        return;
    }
    bool agrees = true;
    for (std::uint32_t frame = 0; frame < kFrames; ++frame) {
        std::array<float, kDimension> z{};
        std::copy_n(elements + frame * kDimension, kDimension, z.begin());
        agrees &= patrol::Monitor::encoder_agrees(frame, z);
        encoder_.values.push_back({"difference at frame " + std::to_string(frame),
                                   text(patrol::Monitor::encoder_difference(frame, z))});
    }
    if (agrees) encoder_.level = Level::ok;
    encoder_.message = agrees ? "is the one of calibration"
                              : "is not the one of calibration: verdicts mean nothing";
}

Report MonitorNode::tick() {
    patrol::Inputs in;
    if (is_new_) in.z = newest_;
    ticks_without_ = is_new_ ? 0 : ticks_without_ + 1;
    is_new_ = false;
    verdicts_ = monitor_.step(in);
    files_.write(monitor_);
    Report report;
    report.verdicts = judge(report.verdicts_changed);
    report.diagnostics = {status_of_encoder(), status_of_embeddings(), status_of_incidents()};
    report.diagnostics.insert(report.diagnostics.end(), report.verdicts.begin(),
                              report.verdicts.end());
    return report;
}

void MonitorNode::reset() {
    monitor_.reset();
    files_.write(monitor_);
    is_new_ = false;
}

std::vector<Status> MonitorNode::judge(bool& changed) {
    std::vector<Status> statuses;
    std::vector<std::uint32_t> answers;
    for (const auto& [name, verdict] : named(verdicts_)) {
        statuses.push_back(status_of(name, verdict));
        answers.push_back(verdict.status);
    }
    changed = answers != answers_;
    answers_ = std::move(answers);
    return statuses;
}

Status MonitorNode::status_of_embeddings() const {
    Status status{Level::ok, "patrol: embeddings", "there is one at every tick", {}};
    if (refused_size_ != 0) {
        status.level = Level::error;
        status.message = "one has " + std::to_string(refused_size_) + " elements, expected " +
                         std::to_string(kDimension);
    } else if (ticks_without_ > 0) {
        status.level = Level::stale;
        status.message = "none for " + std::to_string(ticks_without_) + " ticks";
    }
    status.values = {{"taken", std::to_string(taken_)},
                     {"replaced before a tick", std::to_string(replaced_)},
                     {"refused", std::to_string(refused_)},
                     {"steps with something unknown", std::to_string(monitor_.missing_steps())}};
    return status;
}

Status MonitorNode::status_of_incidents() const {
    Status status{Level::ok, "patrol: incidents", "all are in files", {}};
    if (!files_.mistake().empty()) {
        status.level = Level::error;
        status.message = files_.mistake();
    } else if (files_.lost() > 0) {
        status.level = Level::warn;
        status.message = "some found no room in the recorder";
    }
    status.values = {{"written", std::to_string(files_.written())},
                     {"lost", std::to_string(files_.lost())},
                     {"last", files_.last()}};
    return status;
}

}  // namespace patrol_node
