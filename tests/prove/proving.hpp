// Random specs whose classes are proved.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compile.hpp"
#include "emit/emit.hpp"
#include "execute/evaluator.hpp"
#include "library/version.hpp"
#include "loading.hpp"
#include "prove/prove.hpp"
#include "reference/reference.hpp"

namespace etlc::tests {

/// Factor on the number of random specs; ETLC_EFFORT=6 proves 200 formulas.
inline int effort() {
    const char* text = std::getenv("ETLC_EFFORT");
    return text == nullptr ? 1 : std::max(1, std::atoi(text));
}

inline std::optional<Compiled> compiled(check::Model model, check::Values values) {
    diag::Sink sink;
    return compile(std::move(model),
                   {.limits = {16U << 20U, 16U << 20U, 64U << 20U}, .values = values}, sink);
}

inline std::optional<Compiled> compiled(const std::string& text, check::Values values) {
    auto model = load(text);
    return model ? compiled(std::move(*model), values) : std::nullopt;
}

inline std::string header_of(const plan::Plan& plan) {
    return emit::header(plan, {"proved", library::kVersion, "", "proved.targets.bin"});
}

inline diag::Result<prove::Proof> proof_of(const plan::Plan& plan, std::uint32_t steps) {
    return prove::prove(plan, {header_of(plan), "proved", steps});
}

inline std::vector<execute::Sample> samples(const reference::Step& step) {
    std::vector<execute::Sample> result;
    for (const std::vector<double>& values : step) {
        execute::Sample sample;
        sample.present = !values.empty();
        for (const double value : values) sample.values.push_back(static_cast<float>(value));
        result.push_back(std::move(sample));
    }
    return result;
}

}  // namespace etlc::tests
