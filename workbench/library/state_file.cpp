#include "library/state_file.hpp"

#include <fmt/format.h>

#include <cstring>
#include <string_view>

#include "check/model/fingerprint.hpp"
#include "data/files/hash.hpp"
#include "execute/archive.hpp"
#include "library/session.hpp"
#include "library/version.hpp"

namespace etlc::library {

namespace {

/// The first byte is not text, so text conversions are detected; the last word is 1, in the byte
/// order of the machine.
struct Head {
    char magic[8] = {'\x89', 'E', 'T', 'L', 'S', 'T', 'A', '\n'};
    std::uint32_t order = 1;
    std::uint32_t format = 1;
    char version[32] = {};
    std::uint64_t spec = 0;
    std::uint64_t data = 0;
    std::uint64_t thresholds = 0;
    std::uint64_t plan = 0;  ///< hash of the printed plan, which the options of etlc_open() change
    std::uint64_t environments = 0;
    std::uint64_t history = 0;
};
static_assert(sizeof(Head) == 96, "there is no padding");

Head head_of(const Program& program, const StateOrigin& origin) {
    const check::Fingerprint made_from = check::fingerprint(program.model());
    Head head;
    std::strncpy(head.version, kVersion, sizeof head.version - 1);
    head.spec = made_from.spec;
    head.data = made_from.data;
    head.thresholds = made_from.thresholds;
    head.plan = data::xxh64(plan::print(program.plan()));
    head.environments = origin.environments;
    head.history = origin.history;
    return head;
}

std::string_view text_of_bytes(std::span<const std::uint8_t> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string kind_of(std::uint64_t environments) {
    return environments == 0 ? "one monitor" : fmt::format("a batch of {}", environments);
}

/// Says how the origin of bytes differs from what is expected.
std::string difference(const Program& program, const Head& found, const Head& expected) {
    const auto other = [&](const char* what) {
        return fmt::format("the state was saved with other {} than those of '{}' here", what,
                           program.model().name);
    };
    if (std::memcmp(found.version, expected.version, sizeof found.version) != 0)
        return fmt::format("the state was saved by etlc {}, this is {}", found.version,
                           expected.version);
    if (found.spec != expected.spec)
        return fmt::format(
            "the state was saved with another spec than '{}' here, or other settings",
            program.model().name);
    if (found.data != expected.data) return other("target sets or weights");
    if (found.thresholds != expected.thresholds) return other("thresholds");
    if (found.plan != expected.plan) return other("options (values, targets_as, lets, max_...)");
    if (found.environments != expected.environments)
        return fmt::format("the state is that of {}, expected that of {}",
                           kind_of(found.environments), kind_of(expected.environments));
    if (found.history != expected.history)
        return fmt::format("the state was saved with a history of {} steps, here it is {}",
                           found.history, expected.history);
    return "";
}

}  // namespace

void begin_state(const Program& program, const StateOrigin& origin,
                 std::vector<std::uint8_t>& bytes) {
    const Head head = head_of(program, origin);
    bytes.resize(sizeof head);
    std::memcpy(bytes.data(), &head, sizeof head);
}

void end_state(std::vector<std::uint8_t>& bytes) {
    const std::uint64_t sum = data::xxh64(text_of_bytes(bytes));
    const std::size_t size = bytes.size();
    bytes.resize(size + sizeof sum);
    std::memcpy(bytes.data() + size, &sum, sizeof sum);
}

std::string open_state(const Program& program, const StateOrigin& origin,
                       std::span<const std::uint8_t>& bytes) {
    const Head expected = head_of(program, origin);
    Head found;
    std::uint64_t sum = 0;
    const bool is_state = bytes.size() >= sizeof found.magic &&
                          std::memcmp(bytes.data(), expected.magic, sizeof expected.magic) == 0;
    if (!is_state) return "these are not the bytes of etlc_save()";
    if (bytes.size() < sizeof found + sizeof sum) return "the state is cut off";
    std::memcpy(&found, bytes.data(), sizeof found);
    if (found.order != expected.order) return "the state was saved on a machine of another kind";
    if (found.format != expected.format)
        return "the state was saved by another version of etlc, in another format";
    found.version[sizeof found.version - 1] = '\0';
    const auto content = bytes.first(bytes.size() - sizeof sum);
    std::memcpy(&sum, bytes.data() + content.size(), sizeof sum);
    if (sum != data::xxh64(text_of_bytes(content))) return "the state is cut off or damaged";
    bytes = content.subspan(sizeof found);
    return difference(program, found, expected);
}

// Saves and loads the state of a session.

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
