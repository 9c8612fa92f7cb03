// Prints the telemetry of lets: the verdict of each at the last step.
#include "emit/context.hpp"

namespace etlc::emit {

std::vector<Member> let_members(const Context& context) {
    std::vector<Member> result;
    const std::string verdict(context.spelling.verdict);
    for (std::size_t l = 0; l < context.plan.lets.size(); ++l) {
        const std::string& name = context.names.let_member[l];
        result.push_back(
            {verdict, name,
             "what " + context.model.lets[context.plan.lets[l].index].name + " said last",
             fmt::format("{} = {}();", name, verdict), ""});
    }
    return result;
}

void print_let_interface(Printer& out, const Context& context) {
    if (context.plan.lets.empty()) return;
    print_doc(out, fmt::format("The verdict of each let at the last step{}.",
                               context.on_demand ? "" : ", and its robustness"));
    for (std::size_t l = 0; l < context.plan.lets.size(); ++l) {
        const std::string& name = context.model.lets[context.plan.lets[l].index].name;
        const std::string& member = context.names.let_member[l];
        out.line("{} let_{}() const noexcept {{ return {}; }}", context.spelling.verdict, name,
                 member);
        if (!context.on_demand)
            out.line("float robustness_{}() const noexcept {{ return {}.robustness; }}", name,
                     member);
    }
    out.line();
}

namespace {

/// Returns the value of a let, without its sample.
std::string value_of(const Context& context, const plan::Let& let) {
    const std::string value = context.value(let.stream);
    return context.explains ? fmt::format("etlmon::unsourced({})", value) : value;
}

}  // namespace

/// Lets keep their last verdict during finish().
void print_lets(Printer& out, const Context& context) {
    const plan::Plan& plan = context.plan;
    if (plan.lets.empty()) return;
    out.gap();
    if (plan.has_sliding) out.open("if (finishes_ == 0) {");
    for (std::size_t l = 0; l < plan.lets.size(); ++l)
        print_with_comment(
            out,
            fmt::format("{} = etlmon::sliding_verdict({});", context.names.let_member[l],
                        value_of(context, plan.lets[l])),
            context.place(context.model.lets[plan.lets[l].index].span));
    if (plan.has_sliding) out.close();
}

}  // namespace etlc::emit
