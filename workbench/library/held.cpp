#include "library/held.hpp"

#include <array>
#include <atomic>
#include <mutex>
#include <vector>

namespace etlc::library {

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

}  // namespace etlc::library
