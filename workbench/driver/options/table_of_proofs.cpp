// The options of etlc prove.
#include <vector>

#include "driver/options/tables.hpp"

namespace etlc::driver {

std::vector<Option> options_of_proofs() {
    using enum Command;
    return {
        {prove, "--steps", number<std::uint32_t>(in(&Call::prove, &Call::Prove::steps), 1, 10000),
         "length of the longest inputs (default: twice the longest horizon and the longest "
         "buffer, at least 64)"},
        {prove, "--header", file(in(&Call::prove, &Call::Prove::header)),
         "prove the class in this file, which etlc generated from the spec with the same options "
         "(default: the class that etlc generates now)"},
        {prove, "--counterexample", text("STEM", in(&Call::prove, &Call::Prove::counterexample)),
         "where to write an input on which the class is wrong, and the spec that reads it: "
         "STEM.csv and STEM.etl (default: SPEC.counterexample in this folder)"},
        {prove, "-o,--output", file(in(&Call::output), "-"),
         "where to write the certificate; - is standard output"},
    };
}

}  // namespace etlc::driver
