// What the programs need of a board: a line of text out, an end, a timer. boards/ has one source a
// board.
#pragma once

/// Writes `text`, which ends with a 0.
void board_write(const char* text) noexcept;
/// Ends the run; `status` 0 is success.
[[noreturn]] void board_exit(int status) noexcept;
/// Instructions since the start, or a number that grows with them; 0 where the board has no
/// counter.
unsigned board_instructions() noexcept;

/// From now on a timer calls `handler`, between any two instructions of the program, again and
/// again at intervals that vary. It takes the counter of board_instructions() for that.
void board_start_interrupts(void (*handler)()) noexcept;
/// Keeps the handler out, for a few assignments that belong together.
class BoardInterruptsOff {
public:
    BoardInterruptsOff() noexcept;
    ~BoardInterruptsOff() noexcept;
    BoardInterruptsOff(const BoardInterruptsOff&) = delete;
    BoardInterruptsOff& operator=(const BoardInterruptsOff&) = delete;
};
