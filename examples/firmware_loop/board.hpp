// The interface of a board: text output, exit, a timer. boards/ has one source per board.
#pragma once

/// Writes `text`, which ends with a 0.
void board_write(const char* text) noexcept;
/// Ends the run; `status` 0 is success.
[[noreturn]] void board_exit(int status) noexcept;
/// Returns the instructions since the start, or a number that grows with them; 0 if the board has
/// no counter.
unsigned board_instructions() noexcept;

/// Starts a timer that calls `handler` between any two instructions of the program, repeatedly at
/// varying intervals. It uses the counter of board_instructions().
void board_start_interrupts(void (*handler)()) noexcept;
/// Blocks the handler, for a few assignments that belong together.
class BoardInterruptsOff {
public:
    BoardInterruptsOff() noexcept;
    ~BoardInterruptsOff() noexcept;
    BoardInterruptsOff(const BoardInterruptsOff&) = delete;
    BoardInterruptsOff& operator=(const BoardInterruptsOff&) = delete;
};
