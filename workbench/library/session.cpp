#include "library/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <mutex>
#include <string_view>

#include "check/model/fingerprint.hpp"
#include "data/files/hash.hpp"
#include "execute/archive.hpp"
#include "explain/report.hpp"
#include "ir/lower.hpp"
#include "library/version.hpp"
#include "source/text.hpp"

namespace etlc::library {

Session::Session(std::shared_ptr<const Program> program, std::uint64_t history)
    : program_(std::move(program)), evaluator_(plan(), program_->tables()), history_(history) {
    make_room();
    if (plan().recorder) recorder_.emplace(plan());
    if (history == 0) return;
    observations_.emplace(model(), plan().values, plan().predicates, plan().inputs);
    observations_->reserve(history);
    atoms_.emplace(observations_->plan());
}

Session::Session(std::shared_ptr<const Program> program, Batch batch)
    : program_(std::move(program)),
      evaluator_(plan(), program_->tables()),
      batch_(std::move(batch)) {
    make_room();
}

Session::Session(std::shared_ptr<const Program> program, const Batch& batch,
                 std::uint64_t environment)
    : program_(std::move(program)), evaluator_(plan(), program_->tables()) {
    make_room();
    evaluator_.state() = batch.state(environment);
    is_ended_ = evaluator_.state().finished > 0;
    steps_ = batch.steps(environment);
    verdicts_ = evaluator_.state().verdicts;
}

Session::Session(const Session& other)
    : program_(other.program_),
      evaluator_(plan(), program_->tables()),
      steps_(other.steps_),
      is_ended_(other.is_ended_),
      recorder_(other.recorder_),
      history_(other.history_),
      thresholds_moved_(other.thresholds_moved_) {
    make_room();
    verdicts_ = other.verdicts_;
    evaluator_.state() = other.evaluator_.state();
    if (other.batch_) batch_.emplace(*other.batch_);
    if (!other.observations_) return;
    observations_.emplace(model(), plan().values, plan().predicates, plan().inputs);
    observations_->reserve(history_);
    observations_->take(*other.observations_);
    atoms_.emplace(observations_->plan());
    atoms_->state() = other.atoms_->state();
}

void Session::make_room() {
    samples_.resize(model().inputs.size());
    for (Index input = 0; input < samples_.size(); ++input)
        samples_[input].values.reserve(model().inputs[input].dimension);
    verdicts_.resize(plan().monitors.size());
}

const std::vector<etlmon::Verdict>& Session::step() {
    verdicts_ = evaluator_.step(samples_);
    if (recorder_) recorder_->step(evaluator_, verdicts_);
    if (observations_ && steps_ < history_) {
        atoms_->step(samples_);
        observations_->add(*atoms_);
    }
    ++steps_;
    return verdicts_;
}

const std::vector<etlmon::Verdict>& Session::finish() {
    is_ended_ = true;
    verdicts_ = evaluator_.finish();
    if (recorder_) recorder_->finish(verdicts_);
    return verdicts_;
}

void Session::restart(std::size_t monitor) {
    evaluator_.restart(monitor);
    if (recorder_) recorder_->restart(monitor);
}

void Session::reset() {
    evaluator_.reset();
    if (recorder_) recorder_->end_episode();
    if (observations_) {
        atoms_->reset();
        observations_->clear();
    }
    std::fill(verdicts_.begin(), verdicts_.end(), etlmon::Verdict{});
    steps_ = 0;
    is_ended_ = false;
}

void Session::observe(Index predicate, float distance, bool truth) {
    const float before = evaluator_.threshold(predicate);
    evaluator_.observe(predicate, distance, truth);
    thresholds_moved_ = thresholds_moved_ || before != evaluator_.threshold(predicate);
}

std::string Session::why_unexplained() const {
    if (!observations_)
        return "no step was kept to explain a verdict with: open the spec with a history";
    if (steps_ > history_)
        return fmt::format(
            "the history holds {} of the episode's {} steps: open the spec with a "
            "longer one",
            history_, steps_);
    if (thresholds_moved_)
        return "adaptive thresholds have moved, and what they were at each step is not kept";
    return "";
}

const std::string& Session::explain(std::size_t monitor, bool as_json) {
    const explain::Question question{plan().monitors[monitor].index, evaluator_.position(monitor),
                                     steps_ - 1};
    const explain::Report report =
        explain::report(*observations_, ir::lower(model()), question, verdicts_[monitor]);
    explanation_ = as_json ? explain::json(report) : source::visible_lines(explain::text(report));
    return explanation_;
}

/// A place for a session. Its number has the place, from 1, in the low half, and the number of
/// earlier uses of the place in the high half.
struct Slot {
    std::atomic<bool> busy{false};
    std::atomic<std::uint32_t> uses{0};  ///< changes only while busy
    std::uint32_t place = 0;
    Session* session = nullptr;
};

namespace {

constexpr std::uint32_t kInBlock = 256;
constexpr std::uint32_t kBlocks = 1U << 14U;
using Block = std::array<Slot, kInBlock>;

/// Blocks are never freed, since a program may look up a number while it exits.
std::array<std::atomic<Block*>, kBlocks> blocks;
std::mutex opening;  ///< guards the two below
std::vector<Slot*>& free_slots() {
    static auto* const slots = new std::vector<Slot*>;
    return *slots;
}
std::uint32_t used_blocks = 0;

Slot* slot_of(std::uint64_t number) {
    const auto place = static_cast<std::uint32_t>(number);
    if (place == 0 || (place - 1) / kInBlock >= kBlocks) return nullptr;
    Block* const block = blocks[(place - 1) / kInBlock].load(std::memory_order_acquire);
    return block == nullptr ? nullptr : &(*block)[(place - 1) % kInBlock];
}

void add_block() {
    std::vector<Slot*>& slots = free_slots();
    slots.reserve(std::size_t{used_blocks + 1} * kInBlock);  // so that freeing a slot cannot fail
    auto block = std::make_unique<Block>();
    for (std::uint32_t i = kInBlock; i-- > 0;) {
        (*block)[i].place = used_blocks * kInBlock + i + 1;
        slots.push_back(&(*block)[i]);
    }
    blocks[used_blocks++].store(block.release(), std::memory_order_release);
}

}  // namespace

Held::Held(std::uint64_t number) noexcept {
    Slot* const slot = slot_of(number);
    const auto is_meant = [&] {
        return slot->uses.load(std::memory_order_relaxed) == number >> 32U;
    };
    if (slot == nullptr || !is_meant()) return;
    if (slot->busy.exchange(true, std::memory_order_acquire)) {
        state_ = State::busy;
        return;
    }
    if (slot->session == nullptr || !is_meant()) {
        slot->busy.store(false, std::memory_order_release);
        return;
    }
    slot_ = slot;
    session_ = slot->session;
    state_ = State::held;
}

Held::~Held() {
    if (slot_ != nullptr) slot_->busy.store(false, std::memory_order_release);
}

std::unique_ptr<Session> Held::close() {
    const std::lock_guard lock(opening);
    std::unique_ptr<Session> session(slot_->session);
    slot_->session = nullptr;
    // A place is not used again once its count of uses wraps.
    if (++slot_->uses != 0) free_slots().push_back(slot_);
    slot_->busy.store(false, std::memory_order_release);
    slot_ = nullptr;
    return session;
}

std::uint64_t hold(std::unique_ptr<Session> session) {
    const std::lock_guard lock(opening);
    std::vector<Slot*>& slots = free_slots();
    if (slots.empty() && used_blocks == kBlocks) return 0;
    if (slots.empty()) add_block();
    Slot* const slot = slots.back();
    // A lookup of an old number holds the slot briefly.
    while (slot->busy.exchange(true, std::memory_order_acquire)) {
    }
    slots.pop_back();
    slot->session = session.release();
    const std::uint64_t number = std::uint64_t{slot->uses} << 32U | slot->place;
    slot->busy.store(false, std::memory_order_release);
    return number;
}

namespace {

// The bytes of etlc_save(): a head that says what they are a state of, the numbers, and a checksum.

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
    std::uint64_t environments = 0;  ///< 0: no batch
    std::uint64_t history = 0;
};
static_assert(sizeof(Head) == 96, "there is no padding");

Head head_of(const Program& program, const Batch* batch, std::uint64_t history) {
    const check::Fingerprint made_from = check::fingerprint(program.model());
    Head head;
    std::strncpy(head.version, kVersion, sizeof head.version - 1);
    head.spec = made_from.spec;
    head.data = made_from.data;
    head.thresholds = made_from.thresholds;
    head.plan = data::xxh64(plan::print(program.plan()));
    head.environments = batch == nullptr ? 0 : batch->size();
    head.history = history;
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

template <class Part>
void append(std::vector<std::uint8_t>& bytes, const Part& part) {
    const auto* const first = reinterpret_cast<const std::uint8_t*>(&part);
    bytes.insert(bytes.end(), first, first + sizeof part);
}

/// Checks head and checksum, and takes them away. Returns what is wrong; else an empty text.
std::string open_state(const Program& program, const Head& expected,
                       std::span<const std::uint8_t>& bytes) {
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

}  // namespace

const std::vector<std::uint8_t>& Session::save() {
    saved_.clear();
    append(saved_, head_of(*program_, batch(), history_));
    write_state(saved_);
    append(saved_, data::xxh64(text_of_bytes(saved_)));
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
    const Head expected = head_of(*program_, batch(), history_);
    if (std::string why = open_state(*program_, expected, bytes); !why.empty()) return why;
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
