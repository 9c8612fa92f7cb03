#include "library/open.hpp"

#include "data/files/file.hpp"
#include "parse/parse.hpp"

namespace etlc::library {

bool read_spec(const std::string& path, source::File& file, diag::Sink& sink) {
    // Far more than parse/ accepts, which refuses a large spec with its size and advice.
    constexpr std::size_t kMostRead = 64 * parse::kMaxSpecBytes;
    auto text = data::read_file(path, kMostRead, diag::Code::unreadable_spec, data::Streams::taken);
    file = source::File(path, text ? std::move(*text) : "");
    if (!text) sink.report(data::in_file(text.failure(), path));
    return static_cast<bool>(text);
}

std::optional<pipeline::Compiled> compile(const source::File& file, const check::Options& check,
                                          const pipeline::Options& options, diag::Sink& sink) {
    ast::Spec spec = parse::parse(file, sink);
    auto model = check::check(std::move(spec), file, check, sink);
    if (!model || sink.has_errors()) return std::nullopt;
    return pipeline::compile(std::move(*model), options, sink);
}

}  // namespace etlc::library
