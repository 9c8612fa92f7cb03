// An RV32IMAFC without an operating system (QEMU's virt machine): start, and semihosting for text.
// RISC-V Semihosting Specification 0.4; RISC-V Privileged Architecture, 3.1.6 to 3.1.9 and 3.2.1.
// The attribute of an interrupt handler makes the compiler save the registers that it changes,
// including floating-point registers.
#include <stdint.h>

#include "board.hpp"
#include "intervals.hpp"

extern "C" {
extern uint32_t bss_start, bss_end;
int main();
[[noreturn]] void run() noexcept;
}

__asm__(
    ".section .start, \"ax\"\n"
    ".globl start\n"
    "start:\n"
    "  la sp, stack_top\n"
    "  la t0, fault\n"
    "  csrw mtvec, t0\n"
    "  li t0, 0x2000\n"  // mstatus.FS = initial: the floating-point unit is on
    "  csrs mstatus, t0\n"
    "  j run\n"
    "  .balign 4\n"
    "fault:\n"
    "  li a0, 2\n"
    "  call board_fault\n"
    ".text\n");

namespace {

uint32_t semihost(uint32_t operation, const void* argument) noexcept {
    register uint32_t a0 __asm__("a0") = operation;
    register const void* a1 __asm__("a1") = argument;
    __asm__ volatile(
        ".option push\n .option norvc\n .balign 16\n"
        "slli zero, zero, 0x1f\n ebreak\n srai zero, zero, 7\n"
        ".option pop"
        : "+r"(a0)
        : "r"(a1)
        : "memory");
    return a0;
}

constexpr uint32_t kTimerInterrupts = 1u << 7, kInterrupts = 1u << 3;  // in mie and in mstatus

void (*on_tick)() = nullptr;
Intervals intervals;

/// Schedules the next interrupt that many ticks from now.
void interrupt_after(uint32_t ticks) noexcept {
    auto* time = reinterpret_cast<volatile uint64_t*>(0x0200bff8);
    auto* compare = reinterpret_cast<volatile uint32_t*>(0x02004000);
    const uint64_t then =
        *time + ticks;  // two reads: the low half wraps after seven minutes, longer than any run
    compare[1] = 0xffffffff;  // no interrupt between the two assignments
    compare[0] = static_cast<uint32_t>(then);
    compare[1] = static_cast<uint32_t>(then >> 32);
}

__attribute__((interrupt("machine"), aligned(4))) void tick() noexcept {
    uint32_t cause = 0;
    __asm__ volatile("csrr %0, mcause" : "=r"(cause));
    if (cause != 0x80000007) board_exit(2);
    on_tick();
    interrupt_after(intervals.next());
}

}  // namespace

extern "C" {
[[noreturn]] void board_fault(int status) noexcept {
    board_exit(status);
}

void run() noexcept {
    for (uint32_t* p = &bss_start; p != &bss_end; ++p) *p = 0;
    board_exit(main());
}
}

void board_write(const char* text) noexcept {
    semihost(0x04, text);
}

void board_exit(int status) noexcept {
    const uint32_t block[2] = {0x20026, static_cast<uint32_t>(status)};
    for (;;) semihost(0x20, block);
}

unsigned board_instructions() noexcept {
    unsigned count = 0;
    __asm__ volatile("csrr %0, minstret" : "=r"(count));
    return count;
}

void board_start_interrupts(void (*handler)()) noexcept {
    on_tick = handler;
    __asm__ volatile("csrw mtvec, %0" : : "r"(tick));
    interrupt_after(intervals.next());
    __asm__ volatile("csrs mie, %0\n csrs mstatus, %1"
                     :
                     : "r"(kTimerInterrupts), "r"(kInterrupts)
                     : "memory");
}
BoardInterruptsOff::BoardInterruptsOff() noexcept {
    __asm__ volatile("csrc mstatus, %0" : : "r"(kInterrupts) : "memory");
}
BoardInterruptsOff::~BoardInterruptsOff() noexcept {
    __asm__ volatile("csrs mstatus, %0" : : "r"(kInterrupts) : "memory");
}
