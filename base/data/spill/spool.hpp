// Values in the order in which they came, of which any number takes little memory.
// Takes: values that pack.hpp can pack, one after the other. Gives: them back, all in order or any
// one. Keeps true: memory is that of one value, of 8 bytes for each, and of a SpillFile.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "data/spill/file.hpp"
#include "data/spill/pack.hpp"

namespace etlc::data {

template <class T>
class Spool {
public:
    void add(const T& value) {
        Writer writer;
        writer(value);
        begins_.push_back(bytes_.append(writer.bytes()));
    }

    std::size_t size() const { return begins_.size(); }
    bool empty() const { return begins_.empty(); }

    T operator[](std::size_t i) const {
        const std::uint64_t end = i + 1 < begins_.size() ? begins_[i + 1] : bytes_.size();
        std::string packed(static_cast<std::size_t>(end - begins_[i]), '\0');
        bytes_.read(begins_[i], packed.data(), packed.size());
        auto value = unpacked<T>(packed);
        if (!value) throw SpillError("a temporary file was changed by another program");
        return std::move(*value);
    }

    /// Calls `visit(i, value)` for each.
    template <class Visit>
    void for_each(const Visit& visit) const {
        for (std::size_t i = 0; i < size(); ++i) visit(i, (*this)[i]);
    }

private:
    std::vector<std::uint64_t> begins_;
    SpillFile bytes_;
};

}  // namespace etlc::data
