// What all functions of the interface do first.
#pragma once

#include "library/etlc.h"
#include "library/handles.hpp"
#include "library/message.hpp"

namespace etlc::library {

/// `work(held)`, where the number stands for a session that no other thread is using.
template <class Work>
etlc_status with_held(etlc_session number, const Work& work) noexcept {
    return guarded([&]() -> etlc_status {
        Held held(number);
        if (held.state() == Held::State::held) return work(held);
        if (held.state() == Held::State::busy)
            return refuse(ETLC_BUSY,
                          "session {:#x} is in a call of another thread: a session is used by one "
                          "thread at a time",
                          number);
        return refuse(ETLC_NO_SESSION,
                      "session {:#x} is not open: it was closed, or never given by etlc_open()",
                      number);
    });
}

/// `work(session)`, in the same way.
template <class Work>
etlc_status with_session(etlc_session number, const Work& work) noexcept {
    return with_held(number, [&](Held& held) -> etlc_status { return work(*held); });
}

/// Of an input's elements.
inline std::uint32_t type_of(const check::Input& input) {
    switch (input.type) {
        case check::InputType::boolean: return ETLC_BOOL;
        case check::InputType::f16: return ETLC_F16;
        case check::InputType::i8: return ETLC_I8;
        case check::InputType::scalar:
        case check::InputType::f32: break;
    }
    return ETLC_F32;
}

inline etlc_status refuse_null(const char* what) {
    return refuse(ETLC_NULL_POINTER, "{} is null", what);
}

inline etlc_status refuse_index(const char* what, std::uint64_t found, std::uint64_t count) {
    return refuse(ETLC_NO_SUCH, "there is no {} {}: the spec has {} of them", what, found, count);
}

/// `found`: what the caller says is the size of a struct.
inline etlc_status check_size(std::uint32_t found, std::size_t expected, const char* what) {
    if (found == expected) return ETLC_OK;
    return refuse(ETLC_WRONG_VERSION,
                  "struct_size of {} is {}, expected {}: set it to the sizeof of the struct, from "
                  "the etlc.h of this library",
                  what, found, expected);
}

/// A struct that the caller made, of the size that this version knows.
template <class Struct>
etlc_status check_struct(const Struct* given, const char* what) {
    if (given == nullptr) return refuse_null(what);
    return check_size(given->struct_size, sizeof(Struct), what);
}

}  // namespace etlc::library
