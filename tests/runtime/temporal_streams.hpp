// Shared by the temporal tests: value types, random streams, and the operators written as loops
// over a stream. Takes: a stream of right and left operands and a range of positions. Gives: the
// operator's value, by its definition. Keeps true: nothing here calls the monoids or the windows
// under test; loops compare only through min_of and max_of of V.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "etlmon/hosted/footprint.hpp"
#include "etlmon/temporal/boolean_window.hpp"
#include "etlmon/temporal/handover.hpp"
#include "etlmon/temporal/widening.hpp"
#include "etlmon/temporal/window.hpp"

namespace temporal {

/// 32 Boolean streams side by side, a value type that the runtime does not have.
struct Bits {
    uint32_t word;
};
constexpr Bits min_of(Bits a, Bits b) noexcept {
    return {a.word & b.word};
}
constexpr Bits max_of(Bits a, Bits b) noexcept {
    return {a.word | b.word};
}

}  // namespace temporal

template <>
struct etlmon::Lattice<temporal::Bits> {
    static constexpr temporal::Bits bottom() noexcept { return {0}; }
    static constexpr temporal::Bits top() noexcept { return {~uint32_t{0}}; }
};

template <>
struct etlmon::Lattice<float> {
    static float bottom() noexcept { return float_of(kBottom); }
    static float top() noexcept { return float_of(kTop); }
};

namespace temporal {

using etlmon::Key;
using etlmon::Lattice;
using etlmon::max_of;
using etlmon::min_of;
using etlmon::Span;
using etlmon::Truth;
using etlmon::Value;

/// The name of a value type in typed tests.
template <class V>
constexpr const char* kNameOf = "";
template <>
inline constexpr const char* kNameOf<Key> = "Key";
template <>
inline constexpr const char* kNameOf<float> = "Float";
template <>
inline constexpr const char* kNameOf<Value> = "Value";
template <>
inline constexpr const char* kNameOf<Bits> = "Bits";
template <>
inline constexpr const char* kNameOf<Truth> = "Truth";

inline bool same(Key a, Key b) {
    return a == b;
}
inline bool same(float a, float b) {
    return etlmon::key_of(a) == etlmon::key_of(b);
}
inline bool same(Value a, Value b) {
    return a.low == b.low && a.high == b.high;
}
inline bool same(Truth a, Truth b) {
    return a.low == b.low && a.high == b.high;
}
inline bool same(Bits a, Bits b) {
    return a.word == b.word;
}

/// Returns a random value: mostly one of few levels, so that ties occur, with infinities and the
/// smallest denormals among them.
template <class V>
V random_value(std::mt19937& random);

template <>
inline Key random_value<Key>(std::mt19937& random) {
    const uint32_t kind = random() % 16;
    if (kind == 0) return etlmon::kTop;
    if (kind == 1) return etlmon::kBottom;
    if (kind < 8) return static_cast<Key>(random() % 7) - 3;
    return static_cast<Key>(static_cast<int64_t>(random() % 0xff000001u) - 0x7f800000);
}
template <>
inline float random_value<float>(std::mt19937& random) {
    return etlmon::float_of(random_value<Key>(random));
}
template <>
inline Value random_value<Value>(std::mt19937& random) {
    const Key a = random_value<Key>(random);
    const Key b = random() % 2 != 0 ? a : random_value<Key>(random);
    return a < b ? Value{a, b} : Value{b, a};
}
template <>
inline Truth random_value<Truth>(std::mt19937& random) {
    const uint32_t kind = random() % 8;  // rarely true, so that windows are empty
    return kind == 0 ? etlmon::kYes : kind == 1 ? etlmon::kPerhaps : etlmon::kNo;
}
template <>
inline Bits random_value<Bits>(std::mt19937& random) {
    return {static_cast<uint32_t>(random())};
}

/// A pair of signals: g is the right and f the left operand of a binary operator; unary operators
/// read g.
template <class V>
struct Streams {
    std::vector<V> g, f;
};

template <class V>
Streams<V> random_streams(size_t length, uint32_t seed) {
    std::mt19937 random(seed);
    Streams<V> streams;
    for (size_t i = 0; i < length; ++i) {
        streams.g.push_back(random_value<V>(random));
        streams.f.push_back(random_value<V>(random));
    }
    return streams;
}

/// Names a typed test after its operator and value type.
struct CaseNames {
    template <class Case>
    static std::string GetName(int) {
        return std::string(Case::kName) + kNameOf<typename Case::Value>;
    }
};

// For each operator: how its element is made, how its result is read, and its definition over
// positions [first, last].

template <class V>
struct GreatestCase {
    using Value = V;
    using Monoid = etlmon::Greatest<V>;
    static constexpr const char* kName = "Greatest";
    static V element(const Streams<V>& s, size_t at) { return s.g[at]; }
    static V result(V element) { return element; }
    static V defined(const Streams<V>& s, size_t first, size_t last) {
        V value = Lattice<V>::bottom();
        for (size_t j = first; j <= last; ++j) value = max_of(value, s.g[j]);
        return value;
    }
};

template <class V>
struct LeastCase {
    using Value = V;
    using Monoid = etlmon::Least<V>;
    static constexpr const char* kName = "Least";
    static V element(const Streams<V>& s, size_t at) { return s.g[at]; }
    static V result(V element) { return element; }
    static V defined(const Streams<V>& s, size_t first, size_t last) {
        V value = Lattice<V>::top();
        for (size_t j = first; j <= last; ++j) value = min_of(value, s.g[j]);
        return value;
    }
};

template <class V>
struct BinaryCase {
    using Value = V;
    static Span<V> element(const Streams<V>& s, size_t at) { return {s.g[at], s.f[at]}; }
    template <class Element>
    static V result(Element element) {
        return element.value;
    }
};

template <class V>
struct SinceCase : BinaryCase<V> {
    using Monoid = etlmon::Since<V>;
    static constexpr const char* kName = "Since";
    static V defined(const Streams<V>& s, size_t first, size_t last) {
        V value = Lattice<V>::bottom();
        V held = Lattice<V>::top();  // min of f over (j, last]
        for (size_t j = last + 1; j-- > first;) {
            value = max_of(value, min_of(s.g[j], held));
            held = min_of(held, s.f[j]);
        }
        return value;
    }
};

template <class V>
struct TriggerCase : BinaryCase<V> {
    using Monoid = etlmon::Trigger<V>;
    static constexpr const char* kName = "Trigger";
    static V defined(const Streams<V>& s, size_t first, size_t last) {
        V value = Lattice<V>::top();
        V released = Lattice<V>::bottom();  // max of f over (j, last]
        for (size_t j = last + 1; j-- > first;) {
            value = min_of(value, max_of(s.g[j], released));
            released = max_of(released, s.f[j]);
        }
        return value;
    }
};

template <class V>
struct UntilCase : BinaryCase<V> {
    using Monoid = etlmon::Until<V>;
    static constexpr const char* kName = "Until";
    static V defined(const Streams<V>& s, size_t first, size_t last) {
        V value = Lattice<V>::bottom();
        V held = Lattice<V>::top();  // min of f over [first, j)
        for (size_t j = first; j <= last; ++j) {
            value = max_of(value, min_of(s.g[j], held));
            held = min_of(held, s.f[j]);
        }
        return value;
    }
};

/// f hands over to g, with the pair of each position made by the monoid.
template <class V, class M>
struct FlanksCase : BinaryCase<V> {
    using Monoid = M;
    static etlmon::Flanks<V> element(const Streams<V>& s, size_t at) {
        return Monoid::at(s.f[at], s.g[at]);
    }
};

template <class V>
struct HandoverCase : FlanksCase<V, etlmon::Handover<V>> {
    static constexpr const char* kName = "Handover";
    static V defined(const Streams<V>& s, size_t first, size_t last) {
        V value = Lattice<V>::bottom();
        for (size_t j = first; j <= last; ++j) {
            V both = Lattice<V>::top();
            for (size_t k = first; k <= j; ++k) both = min_of(both, s.f[k]);
            for (size_t k = j; k <= last; ++k) both = min_of(both, s.g[k]);
            value = max_of(value, both);
        }
        return value;
    }
};

template <class V>
struct CoveredCase : FlanksCase<V, etlmon::Covered<V>> {
    static constexpr const char* kName = "Covered";
    static V defined(const Streams<V>& s, size_t first, size_t last) {
        V value = Lattice<V>::top();
        for (size_t j = first; j <= last; ++j) {
            V either = Lattice<V>::bottom();
            for (size_t k = first; k <= j; ++k) either = max_of(either, s.f[k]);
            for (size_t k = j; k <= last; ++k) either = max_of(either, s.g[k]);
            value = min_of(value, either);
        }
        return value;
    }
};

template <class V>
struct ReleaseCase : BinaryCase<V> {
    using Monoid = etlmon::Release<V>;
    static constexpr const char* kName = "Release";
    static V defined(const Streams<V>& s, size_t first, size_t last) {
        V value = Lattice<V>::top();
        V released = Lattice<V>::bottom();  // max of f over [first, j)
        for (size_t j = first; j <= last; ++j) {
            value = min_of(value, max_of(s.g[j], released));
            released = max_of(released, s.f[j]);
        }
        return value;
    }
};

}  // namespace temporal
