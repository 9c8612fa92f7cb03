// A program on an operating system; its interrupts are the signals of a timer.
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/time.h>

#include "board.hpp"

void board_write(const char* text) noexcept {
    fputs(text, stdout);
}
void board_exit(int status) noexcept {
    exit(status);
}
unsigned board_instructions() noexcept {
    return 0;
}

namespace {
void (*on_tick)() = nullptr;
void allow(int how) noexcept {
    sigset_t alarm;
    sigemptyset(&alarm);
    sigaddset(&alarm, SIGALRM);
    sigprocmask(how, &alarm, nullptr);
}
}  // namespace

void board_start_interrupts(void (*handler)()) noexcept {
    on_tick = handler;
    struct sigaction action = {};
    action.sa_handler = [](int) { on_tick(); };
    sigaction(SIGALRM, &action, nullptr);
    const itimerval period = {{0, 50}, {0, 50}};
    setitimer(ITIMER_REAL, &period, nullptr);
}
BoardInterruptsOff::BoardInterruptsOff() noexcept {
    allow(SIG_BLOCK);
}
BoardInterruptsOff::~BoardInterruptsOff() noexcept {
    allow(SIG_UNBLOCK);
}
