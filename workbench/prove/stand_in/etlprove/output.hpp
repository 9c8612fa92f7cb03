// What the program that steps a class says on standard output; prove/answers.cpp reads it.
#pragma once

#include <vector>

#include "etlprove/space.hpp"

namespace etlprove {

/// The words that begin an entry.
enum class Entry : uint32_t {
    number = 1,
    node,
    verdict,
    reset,
    together,
    window,
    end,
    status,
    finished,
    state
};

inline void put(uint32_t word) {
    if (fwrite(&word, sizeof word, 1, stdout) != 1) _Exit(1);
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
        put(static_cast<uint32_t>(Entry::node));
        put(of);
        put(node.place);
        put(node.without);
        put(node.with);
    }

private:
    std::vector<bool> sent_{true, true};
};

}  // namespace etlprove
