// The names of generated code: all of them are made here.
// Takes: the plan. Gives: a name for everything that the code mentions. Keeps true: names come from
// the spec, are legal C++, differ from each other within their scope, and are the same on every
// run. None is a name that the class has of itself, or that its code reads. For that there is one
// rule:
// - a name of the spec stands alone only as a field of Inputs, Verdicts or Atoms and in the
//   namespace targets, where nothing else is declared; in names of the spec every underscore stands
//   between two other characters;
// - data members end in an underscore, and those named after the spec differ from the class's own;
//   locals are a name or words of a formula with an underscore and more behind it; functions are
//   distance_P, threshold_P and the like, which no local is called;
// - other names of the class have no underscore: now, missing, kStateBytes. (What has one is of no
//   such form: missing_steps(), uint32_t, macros.)
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "emit/text/scope.hpp"
#include "plan/plan.hpp"

namespace etlc::emit {

struct Names {
    /// In measure(): this step's sample; of an embedding, a pointer; none for what is read in
    /// place.
    std::map<check::Index, std::string> input_local;
    /// In measure(): of an embedding read in place, where several distances need its length.
    std::map<check::Index, std::string> direction_local;
    /// In measure(): widened elements, or a flag as a word.
    std::map<check::Index, std::string> input_buffer;
    std::map<check::Index, std::string> distance_local;  ///< in measure(): what the kernel gave
    /// In measure(): delta of a predicate without telemetry.
    std::map<check::Index, std::string> predicate_local;
    /// Field of Atoms; of a Boolean class, a local.
    std::map<check::Index, std::string> predicate_atom;
    /// Function of a class of robustness: all that the predicate can be.
    std::map<check::Index, std::string> predicate_unseen;
    std::map<check::Index, std::string> flag_atom;         ///< as predicate_atom
    std::map<check::Index, std::string> predicate_member;  ///< telemetry, of named predicates
    /// Of named predicates that are more than a distance: for each distance that they read, the
    /// nearest row, and the function that gives it.
    struct Nearest {
        std::string member;
        std::string function;
    };
    std::map<std::pair<check::Index, check::Index>, Nearest> nearest;
    /// Of adaptive predicates: the threshold as it is now.
    std::map<check::Index, std::string> threshold_member;
    std::map<check::Index, std::string> adaptation_constant;  ///< and how it moves
    std::map<check::Index, std::string> hold_member;
    struct OfStream {
        std::string local;   ///< empty: an atom or a constant
        std::string member;  ///< empty: it keeps nothing
    };
    std::vector<OfStream> streams;
    struct OfReading {
        std::string local;
        std::vector<std::string> members;  ///< as plan::members_of lists them
        /// Of straight-line code, likewise: the index in the array that has this name; kNone: the
        /// member is no array.
        std::vector<std::uint32_t> elements;
        std::vector<std::string> locals;   ///< of straight-line code, likewise
        std::string guards, weak, strong;  ///< locals of a machine as a table; else empty
        std::vector<std::string> parts;    ///< locals of what is pending: at the last positions
        std::string count;                 ///< local: how many of these there are
    };
    std::vector<OfReading> readings;
    /// Per monitor of the plan: a prefix monitor's last verdict.
    std::map<std::size_t, std::string> verdict_member;
    std::vector<std::string> let_member;  ///< per let of the plan: its verdict
    /// Per monitor that restarts: steps since it began, where some part of it asks.
    std::map<std::size_t, std::string> position_member;
    /// Per monitor that restarts after final verdicts: how many there were of each kind.
    std::map<std::size_t, std::string> alarms_member;
    std::map<std::size_t, std::string> fulfilled_member;
    /// Per prefix monitor of a Boolean class: can still change. A repeating one always can, but
    /// after the trace.
    std::map<std::size_t, std::string> open_local;
    /// Per distance whose stored set is searched.
    std::map<check::Index, std::string> search_member;
    std::map<check::Index, std::string> target_array;  ///< per distance: its rows
    /// Per distance: its rows in float16 or int8.
    std::map<check::Index, std::string> narrow_array;
    std::map<check::Index, std::string> weight_array;  ///< per distance
    /// Per projected point: where its elements lie, and the array that they lie in.
    std::map<check::Index, std::string> point_local;
    std::map<check::Index, std::string> point_buffer;
    /// Of a retargetable class: per number in an expression.
    std::map<const check::Expr*, std::string> number_constant;
    /// Per projection that such a point goes through; the offset where it has one.
    std::map<check::Index, std::string> matrix_array;
    std::map<check::Index, std::string> offset_array;
};

Names make_names(const plan::Plan& plan);

}  // namespace etlc::emit
