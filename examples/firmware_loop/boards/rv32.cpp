// An RV32IMAFC without an operating system (QEMU's virt machine): start, and semihosting for text.
// RISC-V Semihosting Specification 0.4; RISC-V Privileged Architecture, 3.1.6.
#include <stdint.h>

#include "board.hpp"

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
