// A Cortex-M4F without an operating system (QEMU's mps2-an386): vectors, start, and semihosting for
// text. ARM "Semihosting for AArch32 and AArch64", 2.0; ARMv7-M Architecture Reference Manual, B1.5
// and B3.3. On an interrupt the processor saves the registers that a function may change, including
// those of the floating-point unit (B1.5.7), so a handler is a plain function.
#include <stdint.h>

#include "board.hpp"
#include "intervals.hpp"

extern "C" {
extern uint32_t data_start, data_end, bss_start, bss_end, stack_top;
extern const uint32_t data_stored;
int main();
[[noreturn]] void reset() noexcept;
[[noreturn]] void fault() noexcept;
void tick() noexcept;
}

namespace {

volatile uint32_t& at(uint32_t address) noexcept {
    return *reinterpret_cast<volatile uint32_t*>(address);
}

uint32_t semihost(uint32_t operation, const void* argument) noexcept {
    register uint32_t r0 __asm__("r0") = operation;
    register const void* r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

/// SysTick counts down from `ticks` repeatedly.
void count_from(uint32_t ticks, bool interrupts) noexcept {
    at(0xe000e014) = ticks;
    at(0xe000e018) = 0;
    at(0xe000e010) = interrupts ? 7 : 5;
}

void (*on_tick)() = nullptr;
Intervals intervals;

}  // namespace

extern "C" {

/// The processor starts here, with this stack.
__attribute__((section(".vectors"), used)) const void* const vectors[16] = {
    &stack_top,
    reinterpret_cast<const void*>(reset),
    reinterpret_cast<const void*>(fault),  // NMI
    reinterpret_cast<const void*>(fault),  // HardFault
    reinterpret_cast<const void*>(fault),  // MemManage
    reinterpret_cast<const void*>(fault),  // BusFault
    reinterpret_cast<const void*>(fault),  // UsageFault
    nullptr,
    nullptr,
    nullptr,
    nullptr,
    nullptr,
    nullptr,
    nullptr,
    nullptr,
    reinterpret_cast<const void*>(tick),  // SysTick
};

void reset() noexcept {
    at(0xe000ed88) = at(0xe000ed88) | 0xfu << 20;  // CPACR: the floating-point unit is on
    __asm__ volatile("dsb\n isb");
    const uint32_t* from = &data_stored;  // initial states of monitors
    for (uint32_t* p = &data_start; p != &data_end; ++p) *p = *from++;
    for (uint32_t* p = &bss_start; p != &bss_end; ++p) *p = 0;
    count_from(0xffffff, false);
    board_exit(main());
}

void fault() noexcept {
    board_exit(2);
}

void tick() noexcept {
    on_tick();
    count_from(intervals.next(), true);
}
}

void board_write(const char* text) noexcept {
    semihost(0x04, text);
}

void board_exit(int status) noexcept {
    const uint32_t block[2] = {0x20026,
                               static_cast<uint32_t>(status)};  // ADP_Stopped_ApplicationExit
    for (;;) semihost(0x20, block);
}

unsigned board_instructions() noexcept {
    return 0xffffff - at(0xe000e018);
}

void board_start_interrupts(void (*handler)()) noexcept {
    on_tick = handler;
    count_from(intervals.next(), true);
}
BoardInterruptsOff::BoardInterruptsOff() noexcept {
    __asm__ volatile("cpsid i" : : : "memory");
}
BoardInterruptsOff::~BoardInterruptsOff() noexcept {
    __asm__ volatile("cpsie i" : : : "memory");
}
