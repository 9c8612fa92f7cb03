// The choices that one step of a class of truth values makes, for `etlc prove`. Takes: which truths
// each atom may have. Gives: every sequence of choices that the step asks for, one after the other,
// and the condition of each. Keeps true: the conditions exclude each other and cover everything,
// since a step that has had the same answers asks the same question.
#pragma once

#include <stdint.h>

#include <map>
#include <utility>
#include <vector>

#include "etlmon/temporal/demand.hpp"
#include "etlprove/space.hpp"
#include "etlprove/truths.hpp"

namespace etlprove {

/// An atom of the class.
struct Atom {
    uint32_t lazy;  ///< its place among the lazy values of a step; kNoAtom: none
    Truths truths;
    bool vanishes;  ///< it is missing where its inputs are: finish() has none
    bool missing;   ///< what it counts as then, if it is declared
};

class Choices {
public:
    void describe(std::vector<Atom> atoms, TruthPlaces places) {
        atoms_ = std::move(atoms);
        places_ = places;
        for (uint32_t atom = 0; atom < atoms_.size(); ++atom) {
            if (atoms_[atom].lazy == kNoAtom) continue;
            if (of_lazy_.size() <= atoms_[atom].lazy)
                of_lazy_.resize(atoms_[atom].lazy + 1, kNoAtom);
            of_lazy_[atoms_[atom].lazy] = atom;
        }
    }

    /// Begins a step in which these atoms count; others are not known.
    void begin(uint32_t step, const std::vector<bool>& counting, bool finishing) {
        finishing_ = finishing;
        step_ = step;
        counting_ = &counting;
        made_.clear();
        begin_again();
    }
    /// Prepares the next sequence of choices, if there is one.
    bool next() {
        while (!made_.empty() && made_.back().taken + 1 == made_.back().ways.size())
            made_.pop_back();
        if (made_.empty()) return false;
        ++made_.back().taken;
        begin_again();
        return true;
    }

    /// Returns whether the monitor is restarted before this step.
    bool is_restarted(uint32_t monitor) {
        return take([&] {
                   const Diagram yes = diagrams().variable(places_.restart(step_, monitor));
                   return Ways{{etlmon::kNo, diagrams().complement(yes)}, {etlmon::kYes, yes}};
               })
            .low;
    }

    uint32_t next_lazy() {
        const uint32_t at = lazies_++;
        return at < of_lazy_.size() ? of_lazy_[at] : kNoAtom;
    }

    etlmon::Truth truth(uint32_t atom) {
        if ((*counting_)[atom] && !(finishing_ && atoms_[atom].vanishes)) {
            if (!answers_[atom].first) answers_[atom] = {true, take([&] { return ways_of(atom); })};
            return answers_[atom].second;
        }
        const Truths truths = atoms_[atom].truths;
        return truths == Truths::any   ? etlmon::kPerhaps
               : truths == Truths::yes ? etlmon::kYes
               : truths == Truths::no  ? etlmon::kNo
                                       : etlmon::truth_of(atoms_[atom].missing);
    }

    /// Returns when the step makes the choices that it made.
    Diagram condition() const { return made_.empty() ? kAlways : made_.back().condition(); }

    /// Returns a condition on the choices of one step as one on those of another.
    Diagram moved(Diagram condition, uint32_t from, uint32_t to) {
        if (condition <= kAlways || from == to) return condition;
        const auto known = moved_.find({condition, to});
        if (known != moved_.end()) return known->second;
        const Diagrams::Node node = diagrams()[condition];
        const Diagram without = moved(node.without, from, to), with = moved(node.with, from, to);
        const Place place = node.place + from * places_.per_step() - to * places_.per_step();
        return moved_[{condition, to}] = diagrams().choose(place, without, with);
    }

private:
    using Ways = std::vector<std::pair<etlmon::Truth, Diagram>>;
    struct Choice {
        Ways ways;
        size_t taken;
        Diagram before;  ///< condition of the choices before
        Diagram condition() const { return diagrams().both(before, ways[taken].second); }
    };

    std::vector<Atom> atoms_;
    TruthPlaces places_{};
    std::vector<uint32_t> of_lazy_;
    const std::vector<bool>* counting_ = nullptr;
    bool finishing_ = false;
    uint32_t step_ = 0, lazies_ = 0;
    size_t asked_ = 0;
    std::vector<Choice> made_;
    std::map<std::pair<Diagram, uint32_t>, Diagram> moved_;
    std::vector<std::pair<bool, etlmon::Truth>> answers_;  ///< of the atoms that were asked

    void begin_again() {
        answers_.assign(atoms_.size(), {false, etlmon::kNo});
        asked_ = 0;
        lazies_ = 0;
    }

    Ways ways_of(uint32_t atom) const {
        Diagrams& all = diagrams();
        const Truths truths = atoms_[atom].truths;
        const Ends ends = ends_of(all, truths, places_.atom(step_, atom));
        if (truths == Truths::yes) return {{etlmon::kYes, kAlways}};
        if (truths == Truths::no) return {{etlmon::kNo, kAlways}};
        Ways ways{{etlmon::kNo, all.complement(ends.high)}, {etlmon::kYes, ends.low}};
        if (truths == Truths::any)
            ways.push_back({etlmon::kPerhaps, all.both(ends.high, all.complement(ends.low))});
        return ways;
    }

    template <class Find>
    etlmon::Truth take(const Find& ways) {
        if (asked_ == made_.size()) {
            const Diagram before = condition();
            made_.push_back({ways(), 0, before});
        }
        const Choice& choice = made_[asked_++];
        return choice.ways[choice.taken].first;
    }
};

inline Choices& choices() {
    static Choices kept;
    return kept;
}

inline uint32_t next_lazy() {
    return choices().next_lazy();
}
inline etlmon::Truth truth_of_atom(uint32_t atom) {
    return choices().truth(atom);
}
inline void refuse_type() {
    stop(kBranches);
}

}  // namespace etlprove
