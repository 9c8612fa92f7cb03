#include "driver/options/call.hpp"

namespace etlc::driver {

std::vector<std::string>& Call::data() {
    switch (command) {
        case Command::embed: return embed.data;
        case Command::fit: return fit.data;
        case Command::calibrate: return calibrate.data;
        case Command::report: return report.data;
        default: return evaluate.data;
    }
}

std::string& Call::groups() {
    switch (command) {
        case Command::embed: return embed.groups;
        case Command::fit: return fit.groups;
        case Command::calibrate: return calibrate.groups;
        case Command::report: return report.groups;
        default: return evaluate.groups;
    }
}

std::string& Call::allow_overlap() {
    switch (command) {
        case Command::fit: return fit.fit.allow_overlap;
        case Command::calibrate: return calibrate.calibration.allow_overlap;
        case Command::report: return report.allow_overlap;
        default: return evaluate.evaluation.allow_overlap;
    }
}

unsigned& Call::jobs() {
    switch (command) {
        case Command::fit: return fit.fit.jobs;
        case Command::calibrate: return calibrate.calibration.jobs;
        case Command::report: return report.report.jobs;
        default: return evaluate.evaluation.jobs;
    }
}

data::NamesInFile& Call::names() {
    switch (command) {
        case Command::run: return run.names;
        case Command::embed: return embed.embed.names;
        case Command::fit: return fit.fit.names;
        case Command::calibrate: return calibrate.calibration.names;
        case Command::explain: return explain.names;
        case Command::report: return report.report.names;
        default: return evaluate.evaluation.names;
    }
}

std::string& Call::trace() {
    return command == Command::run ? run.trace : explain.trace;
}

std::vector<check::Setting>& Call::settings() {
    switch (command) {
        case Command::embed: return embed.settings;
        case Command::fit: return fit.settings;
        case Command::calibrate: return calibrate.settings;
        default: return request.check.settings;
    }
}

std::string& Call::thresholds() {
    return command == Command::calibrate ? calibrate.thresholds : request.check.thresholds_path;
}

std::string& Call::fitted() {
    return command == Command::calibrate ? calibrate.fitted : request.check.fitted_path;
}

std::string& Call::embedded() {
    switch (command) {
        case Command::embed: return embed.embedded;
        case Command::fit: return fit.embedded;
        case Command::calibrate: return calibrate.embedded;
        default: return request.check.embedded_path;
    }
}

std::uint32_t& Call::folds() {
    return command == Command::calibrate ? calibrate.calibration.folds : evaluate.folds;
}

ShardRequest& Call::shard() {
    switch (command) {
        case Command::embed: return embed.shard;
        case Command::calibrate: return calibrate.shard;
        default: return evaluate.shard;
    }
}

std::string& Call::written() {
    switch (command) {
        case Command::run: return run.output;
        case Command::embed: return embed.output;
        case Command::fit: return fit.output;
        case Command::calibrate: return calibrate.output;
        case Command::explain: return explain.output;
        case Command::incident: return incident.output;
        case Command::report: return report.output;
        default: return output.result;
    }
}

}  // namespace etlc::driver
