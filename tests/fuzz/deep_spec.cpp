#include "deep_spec.hpp"

#include <array>

namespace etlc::fuzz {

namespace {

class Writer {
public:
    Writer(const std::uint8_t* bytes, std::size_t size) : bytes_(bytes), size_(size) {}

    std::string write() {
        text_ =
            "spec deep;\ninput x : f32 in [-1, 1];\ninput y : f32;\ninput b : bool;\n"
            "predicate p = x > 0;\npredicate q = y <= 0.5;\npredicate r = x + y >= 0.25;\n";
        do {
            declaration();
        } while (at_ < size_ && has_room());
        if (monitors_ == 0) text_ += "monitor only = F b;\n";
        return std::move(text_);
    }

private:
    /// Returns the next byte, or 0 at the end, which ends every formula.
    unsigned choice(unsigned count) { return at_ < size_ ? bytes_[at_++] % count : 0; }
    bool has_room() const { return text_.size() < kMostSpecBytes; }

    void declaration() {
        std::string formula;
        const unsigned kind = choice(4);
        future_ = kind != 0;
        sliding_ = kind == 1;
        write(formula, kMostLevels);
        if (text_.size() + formula.size() + 40 > kMostSpecBytes) {
            at_ = size_;
        } else if (kind == 0) {
            text_ += "let a" + std::to_string(lets_++) + " = " + formula + ";\n";
        } else {
            text_ += sliding_ ? "sliding monitor m" : "monitor m";
            text_ += std::to_string(monitors_++) + " = " + formula + ";\n";
        }
    }

    void leaf(std::string& out) {
        static constexpr std::array<const char*, 8> kAtoms{"p", "q", "r",    "b",
                                                           "p", "q", "true", "x > 0.5"};
        const unsigned n = choice(static_cast<unsigned>(kAtoms.size() + 2 * lets_));
        if (n < kAtoms.size())
            out += kAtoms[n];
        else
            out += "a" + std::to_string((n - kAtoms.size()) % lets_);
    }

    void interval(std::string& out, bool bounded) {
        static constexpr std::array<const char*, 12> kHighs{
            "0", "1", "2", "3", "5", "9", "40", "300", "1000", "20000", "900000", "2147483646"};
        static constexpr std::array<const char*, 5> kLows{"0", "0", "1", "2", "7"};
        const unsigned n = choice(bounded ? 12 : 24);
        if (n >= kHighs.size()) {
            if (n == 23) out += "[2, inf]";
            return;
        }
        const unsigned low = n < 2   ? 0
                             : n < 4 ? choice(4)
                                     : choice(static_cast<unsigned>(kLows.size() + 1));
        const char* first = low < kLows.size() ? kLows[low] : kHighs[n];
        out += std::string("[") + first + ", " + kHighs[n] + "]";
    }

    void write(std::string& out, int levels) {
        if (levels == 0 || out.size() > kMostSpecBytes || at_ == size_) return leaf(out);
        static constexpr std::array<const char*, 4> kInfix{" && ", " || ", " -> ", " <-> "};
        const unsigned kind = choice(20);
        if (kind < 2) return leaf(out);
        out += '(';
        if (kind < 8) {
            write(out, levels - 1);
            out += kInfix[kind < 4 ? 0 : kind < 6 ? 1 : kind - 4];
            write(out, levels - 1);
        } else if (kind == 8) {
            out += '!';
            write(out, levels - 1);
        } else if (kind < 16 && future_) {
            future(out, levels, kind);
        } else {
            past(out, levels, kind);
        }
        out += ')';
    }

    void future(std::string& out, int levels, unsigned kind) {
        const bool binary = kind >= 13;
        if (binary) write(out, levels - 1);
        out += kind < 11                  ? "F"
               : kind == 11 || kind == 12 ? "G"
               : kind == 13               ? " U"
               : kind == 14               ? " R"
                                          : "";
        if (kind == 15) out += sliding_ ? " U" : " W";
        if (kind != 15 || sliding_) interval(out, sliding_);
        out += ' ';
        write(out, levels - 1);
    }

    /// Makes a formula of a prefix monitor, over the present and the past.
    void past(std::string& out, int levels, unsigned kind) {
        const bool outside = future_;
        future_ = future_ && sliding_;
        if (kind % 4 == 0) write(out, levels - 1);
        static constexpr std::array<const char*, 4> kOperators{" S", "O", "H", "Y"};
        out += kOperators[kind % 4];
        if (kind % 4 != 3) interval(out, false);
        out += ' ';
        write(out, levels - 1);
        future_ = outside;
    }

    static constexpr int kMostLevels = 60;

    const std::uint8_t* bytes_;
    std::size_t size_;
    std::size_t at_ = 0;
    std::string text_;
    std::size_t lets_ = 0;
    std::size_t monitors_ = 0;
    bool future_ = true;    ///< future operators are allowed here
    bool sliding_ = false;  ///< and need an upper bound
};

}  // namespace

std::string deep_spec(const std::uint8_t* bytes, std::size_t size) {
    return Writer(bytes, size).write();
}

}  // namespace etlc::fuzz
