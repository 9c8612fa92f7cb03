// The form of a state: what it does with the samples, wherever they are in the trace.
// Takes: diagrams and control words after a step. Gives: numbers that are equal where the states
// are the same functions of the last samples, and of functions of older samples in the same places.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "prove/symbols/symbol.hpp"

namespace etlc::prove {

class Form {
public:
    /// `first`: the place of the first sample of the step; `older`: that of the older samples.
    Form(const etlprove::Diagrams& diagrams, Place first, Place older)
        : diagrams_(diagrams), first_(first), older_(older) {}

    void add_control(std::uint32_t word) {
        numbers_.push_back(kControl);
        numbers_.push_back(word);
    }
    void add_counter() { numbers_.push_back(kCounter); }
    void add(Diagram diagram) {
        const std::uint32_t number = number_of(diagram);
        numbers_.push_back(kDiagram);
        numbers_.push_back(number);
    }

    const std::vector<std::uint32_t>& numbers() const { return numbers_; }
    /// The functions of older samples, in the order in which they are used first.
    const std::vector<Diagram>& leaves() const { return leaves_; }

private:
    enum Tag : std::uint32_t { kControl, kCounter, kDiagram, kLeaf, kNode };

    /// Returns the number of a diagram, in the order in which they come first.
    std::uint32_t number_of(Diagram diagram) {
        if (diagram <= etlprove::kAlways) return diagram;
        if (const auto found = known_.find(diagram); found != known_.end()) return found->second;
        const etlprove::Diagrams::Node node = diagrams_[diagram];
        if (node.place >= older_) {
            leaves_.push_back(diagram);
            numbers_.push_back(kLeaf);
        } else {
            const std::uint32_t without = number_of(node.without), with = number_of(node.with);
            const bool is_sample = node.place >= etlprove::kFirstSample;
            numbers_.push_back(kNode);
            numbers_.push_back(is_sample ? node.place - first_ + etlprove::kFirstSample
                                         : node.place);
            numbers_.push_back(without);
            numbers_.push_back(with);
        }
        const std::uint32_t number = static_cast<std::uint32_t>(known_.size()) + 2;
        known_.emplace(diagram, number);
        return number;
    }

    const etlprove::Diagrams& diagrams_;
    Place first_, older_;
    std::vector<std::uint32_t> numbers_;
    std::vector<Diagram> leaves_;
    std::unordered_map<Diagram, std::uint32_t> known_;
};

}  // namespace etlc::prove
