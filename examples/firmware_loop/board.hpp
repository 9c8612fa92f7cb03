// What the loop needs of a board: a line of text out, and an end. boards/ has one source a board.
#pragma once

/// Writes `text`, which ends with a 0.
void board_write(const char* text) noexcept;
/// Ends the run; `status` 0 is success.
[[noreturn]] void board_exit(int status) noexcept;
/// Instructions since the start, or a number that grows with them; 0 where the board has no counter.
unsigned board_instructions() noexcept;
