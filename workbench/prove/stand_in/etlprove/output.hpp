// What the program that steps a class says on standard output; prove/answers.cpp reads it.
#pragma once

#include <vector>

#include "etlprove/space.hpp"

namespace etlprove {

/// The words that begin an entry.
enum class Entry : uint32_t { number = 1, node, verdict, state, restarts, saturation, window, end };

inline void put(uint32_t word) {
    if (fwrite(&word, sizeof word, 1, stdout) != 1) _Exit(1);
}
inline void put(Entry entry) {
    put(static_cast<uint32_t>(entry));
}

/// Writes diagrams before those that contain them.
class Sent {
public:
    void send(Diagram of) {
        if (sent_.size() < diagrams().size()) sent_.resize(diagrams().size(), false);
        if (sent_[of]) return;
        const Diagrams::Node node = diagrams()[of];
        send(node.without);
        send(node.with);
        sent_[of] = true;
        put(Entry::node);
        put(of);
        put(node.place);
        put(node.without);
        put(node.with);
    }

private:
    std::vector<bool> sent_{true, true};
};

/// Ends the program: it needs another number.
[[noreturn]] inline void ask_for(float number) {
    uint32_t bits = 0;
    static_assert(sizeof bits == sizeof number, "");
    __builtin_memcpy(&bits, &number, sizeof bits);
    put(Entry::number);
    put(bits);
    stop(kNewNumber);
}

}  // namespace etlprove
