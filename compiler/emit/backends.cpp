#include "emit/emit.hpp"

namespace etlc::emit {

const std::vector<Backend>& backends() {
    static const std::vector<Backend> table = {
        {"hpp", "the monitor class (what -o writes)", header},
        {"params", "the parameters that a class of --retargetable takes, as bytes", params},
        {"dot", "the formulas as a Graphviz graph", dot},
        {"report", "the budget: state, constants, code, work, horizon, per monitor", report},
    };
    return table;
}

}  // namespace etlc::emit
