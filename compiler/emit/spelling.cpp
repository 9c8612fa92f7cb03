#include "emit/spelling.hpp"

namespace etlc::emit {

const Spelling& spelling(check::Values values) {
    static const Spelling kRobustness{
        .value = "etlmon::Value",
        .value_meaning = "a robustness; low and high differ where a sample is missing",
        .atom = "Value",
        .key = "etlmon::Key",
        .reading = "etlmon::Reading",
        .verdict = "etlmon::Verdict",
        .kept = "etlmon::Register",
        .bytes = false,
        .yes = "etlmon::kTrue",
        .no = "etlmon::kFalse",
        .top = "etlmon::kTop",
        .bottom = "etlmon::kBottom",
        .neither = "",
        .predicates = "temporal/predicate",
        .verdicts = "temporal/verdict",
        .delays = "temporal/delay",
        .windows = "temporal/window",
    };
    static const Spelling kTruth{
        .value = "etlmon::Truth",
        .value_meaning = "two bits: surely true, possibly true",
        .atom = "Value",
        .key = "bool",
        .reading = "etlmon::BasicReading<Value>",
        .verdict = "etlmon::BooleanVerdict",
        .kept = "Value",
        .bytes = true,
        .yes = "etlmon::kYes",
        .no = "etlmon::kNo",
        .top = "true",
        .bottom = "false",
        .neither = "etlmon::kPerhaps",
        .predicates = "temporal/demand",
        .verdicts = "temporal/boolean_verdict",
        .delays = "temporal/boolean_window",
        .windows = "temporal/boolean_window",
    };
    static const Spelling kSourced{
        .value = "etlmon::Sourced",
        .value_meaning = "a robustness with its sample; low and high differ where one is missing",
        .atom = "etlmon::Value",
        .key = "etlmon::SourcedKey",
        .reading = "etlmon::BasicReading<Value>",
        .verdict = "etlmon::Verdict",
        .kept = "etlmon::SourcedRegister",
        .bytes = false,
        .yes = "etlmon::kTrueItself",
        .no = "etlmon::kFalseItself",
        .top = "etlmon::kTop",
        .bottom = "etlmon::kBottom",
        .neither = "",
        .predicates = "temporal/predicate",
        .verdicts = "temporal/samples",
        .delays = "temporal/delay",
        .windows = "temporal/window",
    };
    switch (values) {
        case check::Values::robustness: break;
        case check::Values::boolean: return kTruth;
        case check::Values::sourced: return kSourced;
    }
    return kRobustness;
}

}  // namespace etlc::emit
