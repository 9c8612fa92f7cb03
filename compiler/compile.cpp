#include "compile.hpp"

#include <utility>

#include "data/files/file.hpp"
#include "opt/opt.hpp"
#include "parse/parse.hpp"
#include "plan/advice.hpp"

namespace etlc {

bool read_spec(const std::string& path, source::File& file, diag::Sink& sink) {
    // Far more than parse/ accepts, which refuses a large spec with its size and advice.
    constexpr std::size_t kMostRead = 64 * parse::kMaxSpecBytes;
    auto text = data::read_file(path, kMostRead, diag::Code::unreadable_spec, data::Streams::taken);
    file = source::File(path, text ? std::move(*text) : "");
    if (!text) sink.report(data::in_file(text.failure(), path));
    return static_cast<bool>(text);
}

std::optional<Compiled> compile(const source::File& file, const check::Options& check,
                                const CompileOptions& options, diag::Sink& sink) {
    ast::Spec spec = parse::parse(file, sink);
    auto model = check::check(std::move(spec), file, check, sink);
    if (!model || sink.has_errors()) return std::nullopt;
    return compile(std::move(*model), options, sink);
}

std::optional<Compiled> compile(check::Model model, const CompileOptions& options,
                                diag::Sink& sink) {
    Compiled result;
    result.model = std::make_unique<check::Model>(std::move(model));
    result.program = std::make_unique<ir::Program>(ir::lower(*result.model));
    opt::optimise(*result.program);
    auto plan =
        plan::plan(*result.program, options.limits, sink, options.values, options.targets_as,
                   plan::advice_on(*result.model, options.limits, options.values));
    if (plan && options.recorder)
        plan::add_recorder(*plan, *options.recorder, options.limits, sink);
    if (!plan || sink.has_errors()) return std::nullopt;
    result.plan = std::move(*plan);
    return result;
}

}  // namespace etlc
