// The thresholds file: what `etlc calibrate` found, with where it came from.
// Takes: JSON of design "format 1". Gives: one entry per calibrated predicate. Keeps true: every float32 in it reads back to
// the same bits; whether an entry fits the spec is check/'s question, which compares `predicate` and `targets`.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "diag/diag.hpp"

namespace etlc::thresholds {

struct Entry {
    std::string method;     ///< f1, conformal, class_conditional
    std::string alpha;      ///< decimal text exactly as in the spec; empty for f1
    float epsilon = 0;
    std::uint64_t n = 0;    ///< demonstrations (conformal) or frames (class_conditional, f1) that gave scores
    std::uint64_t k = 0;    ///< rank of the score taken; 0 for f1
    std::vector<double> scores;
    std::string predicate;  ///< canonical text, check::Predicate::text
    std::string truth;      ///< canonical text of the truth formula, or "array"
    std::map<std::string, std::string> targets;  ///< target name -> content hash
};

struct File {
    std::string path;
    std::string spec;
    std::string etlc;       ///< version that wrote it
    std::map<std::string, Entry> predicates;
    std::vector<std::string> episodes;  ///< content hashes of the calibration episodes
};

diag::Result<File> read(const std::string& path);
diag::Result<File> parse(const std::string& json, const std::string& path);
std::string write(const File& file);

}  // namespace etlc::thresholds
