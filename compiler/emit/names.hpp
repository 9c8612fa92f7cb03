// Names of generated code, all of which are made here from the plan. They come from the spec, are
// legal C++, differ within their scope, and are the same on every run. No name made from the spec
// collides with another name of the class, by these rules:
// - a name of the spec is used unchanged only as a field of Inputs, Verdicts or Atoms and in the
//   namespace targets, which declare nothing else; it has underscores only between other
//   characters;
// - data members end in an underscore, and the class's own are reserved;
// - locals are a name or words of a formula with an underscore and more behind it; functions are
//   distance_P, threshold_P and the like, which no local is called;
// - other names of the class contain no underscore (now, missing, kStateBytes), but for some that
//   have none of these forms (missing_steps(), uint32_t, macros).
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "check/model/model.hpp"
#include "emit/text/identifiers.hpp"
#include "plan/plan.hpp"

namespace etlc::emit {

struct Names {
    /// In measure(): this step's sample, of an embedding a pointer. Inputs read in place have none.
    std::map<check::Index, std::string> input_local;
    /// In measure(): the direction of an embedding read in place, if several distances need its
    /// length.
    std::map<check::Index, std::string> direction_local;
    /// In measure(): widened elements, or a flag as a word.
    std::map<check::Index, std::string> input_buffer;
    std::map<check::Index, std::string> distance_local;  ///< in measure(): the result of the kernel
    /// In measure(): a number that earlier steps have a part in, and what it is computed from.
    std::map<check::Index, std::string> past_local;
    std::map<check::Index, std::string> past_member;
    /// In measure(): delta of a predicate without telemetry.
    std::map<check::Index, std::string> predicate_local;
    /// Field of Atoms, or a local of a Boolean class.
    std::map<check::Index, std::string> predicate_atom;
    /// Function that returns the range of the predicate; none in a Boolean class.
    std::map<check::Index, std::string> predicate_unseen;
    std::map<check::Index, std::string> flag_atom;         ///< as predicate_atom
    std::map<check::Index, std::string> predicate_member;  ///< telemetry, of named predicates
    /// For each distance that a named predicate reads in an expression: the member that holds the
    /// nearest row, and the function that returns it.
    struct Nearest {
        std::string member;
        std::string function;
    };
    std::map<std::pair<check::Index, check::Index>, Nearest> nearest;
    /// The current threshold of an adaptive predicate.
    std::map<check::Index, std::string> threshold_member;
    std::map<check::Index, std::string> adaptation_constant;  ///< and the constants of its
                                                              ///< adaptation
    /// Per drift of the model: its state, and the constant with the scores of calibration.
    struct OfDrift {
        std::string member;
        std::string cells;
    };
    std::map<check::Index, OfDrift> drifts;
    std::map<check::Index, std::string> hold_member;
    std::map<check::Index, std::string> stale_member;
    struct OfStream {
        std::string local;   ///< empty: an atom or a constant
        std::string member;  ///< empty: no state
    };
    std::vector<OfStream> streams;
    struct OfReading {
        std::string local;
        std::vector<std::string> members;  ///< as plan::members_of lists them
        /// Likewise for straight-line code: index in the array of that name; kNone: not in an
        /// array.
        std::vector<std::uint32_t> elements;
        std::vector<std::string> locals;   ///< of straight-line code
        std::string guards, weak, strong;  ///< locals of a machine as a table; else empty
        std::vector<std::string> parts;    ///< locals of a pending reading: values at the last
                                           ///< positions
        std::string count;                 ///< local: number of these positions
    };
    std::vector<OfReading> readings;
    /// Per monitor of the plan: a prefix monitor's last verdict.
    std::map<std::size_t, std::string> verdict_member;
    std::vector<std::string> let_member;  ///< per let of the plan: its verdict
    /// Per monitor that restarts: steps since its restart, if its formula has bounds.
    std::map<std::size_t, std::string> position_member;
    /// Per monitor that restarts after final verdicts: the number of each kind.
    std::map<std::size_t, std::string> alarms_member;
    std::map<std::size_t, std::string> fulfilled_member;
    /// Per prefix monitor of a Boolean class: whether its verdict can still change. A repeating
    /// monitor is open until the trace ends.
    std::map<std::size_t, std::string> open_local;
    /// Per distance whose stored set is searched.
    std::map<check::Index, std::string> search_member;
    std::map<check::Index, std::string> target_array;  ///< per distance: its rows
    /// Per distance: its rows in float16 or int8.
    std::map<check::Index, std::string> narrow_array;
    std::map<check::Index, std::string> weight_array;  ///< per distance
    /// Per point that is computed or looked up: the pointer to its elements, and their array.
    std::map<check::Index, std::string> point_local;
    std::map<check::Index, std::string> point_buffer;
    /// Per point that some point delays: its samples of earlier steps.
    std::map<check::Index, std::string> earlier_member;
    /// Per number in an expression of a retargetable class.
    std::map<const check::Expr*, std::string> number_constant;
    /// Per projection of such a point; the offset if it has one.
    std::map<check::Index, std::string> matrix_array;
    std::map<check::Index, std::string> offset_array;
};

Names make_names(const plan::Plan& plan);

// The types of values in C++: the spelling of types, constants and runtime headers, one row per
// type. Only this table and plan::ValueType tell the types apart.

struct Spelling {
    // Types.
    std::string value;
    std::string value_meaning;
    std::string atom;  ///< measured predicate or bool
    std::string key;   ///< one end of a value
    std::string reading;
    std::string verdict;
    std::string kept;  ///< value kept between steps
    bool bytes;        ///< values consist of bytes, not words
    // Constants.
    std::string yes;
    std::string no;
    std::string top;  ///< end of a value
    std::string bottom;
    std::string neither;  ///< neither yes nor no; empty: spell both ends
    // Headers of the runtime.
    std::string predicates;
    std::string verdicts;
    std::string delays;
    std::string windows;
};

const Spelling& spelling(check::Values values);

}  // namespace etlc::emit
