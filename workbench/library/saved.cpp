// Saves and loads the state of a session.
#include "execute/archive.hpp"
#include "library/session.hpp"
#include "library/state_file.hpp"

namespace etlc::library {

namespace {

StateOrigin origin_of(const Batch* batch, std::uint64_t history) {
    return {batch == nullptr ? 0 : batch->size(), history};
}

}  // namespace

const std::vector<std::uint8_t>& Session::save() {
    begin_state(*program_, origin_of(batch(), history_), saved_);
    write_state(saved_);
    end_state(saved_);
    return saved_;
}

void Session::write_state(std::vector<std::uint8_t>& bytes) const {
    if (batch_) {
        for (std::uint64_t e = 0; e < batch_->size(); ++e) batch_->state(e).write(bytes);
        return;
    }
    evaluator_.state().write(bytes);
    execute::Writer writer(bytes);
    writer.number(steps_);
    writer.flag(is_ended_);
    writer.flag(thresholds_moved_);
    writer.fixed(verdicts_);
    if (!observations_) return;
    atoms_->state().write(bytes);
    explain::Observations::visit(*observations_, writer);
}

std::string Session::load(std::span<const std::uint8_t> bytes) {
    if (std::string why = open_state(*program_, origin_of(batch(), history_), bytes); !why.empty())
        return why;
    // The states of this session stay as they are until all bytes have been read.
    Session loaded(*this);
    if (!loaded.read_state(bytes) || !bytes.empty()) return "the state is damaged";
    if (batch_) {
        for (std::uint64_t e = 0; e < batch_->size(); ++e)
            batch_->state(e) = loaded.batch_->state(e);
        return "";
    }
    evaluator_.state() = loaded.evaluator_.state();
    steps_ = loaded.steps_;
    is_ended_ = loaded.is_ended_;
    thresholds_moved_ = loaded.thresholds_moved_;
    verdicts_ = loaded.verdicts_;
    if (!observations_) return "";
    atoms_->state() = loaded.atoms_->state();
    observations_->take(*loaded.observations_);
    return "";
}

/// Reads into this session; it must not be used where that fails.
bool Session::read_state(std::span<const std::uint8_t>& bytes) {
    const execute::Tables& tables = *program_->tables();
    if (batch_) {
        for (std::uint64_t e = 0; e < batch_->size(); ++e)
            if (!batch_->state(e).read(bytes, plan(), tables.shape)) return false;
        return true;
    }
    if (!evaluator_.state().read(bytes, plan(), tables.shape)) return false;
    execute::Reader reader(bytes);
    reader.number(steps_);
    reader.flag(is_ended_);
    reader.flag(thresholds_moved_);
    reader.fixed(verdicts_);
    bytes = reader.rest();
    if (!reader.good() || !observations_) return reader.good();
    if (!atoms_->state().read(bytes, observations_->plan(), atoms_->tables()->shape)) return false;
    execute::Reader rest(bytes);
    explain::Observations::visit(*observations_, rest);
    bytes = rest.rest();
    return rest.good() && observations_->fits(std::min(steps_, history_));
}

}  // namespace etlc::library
