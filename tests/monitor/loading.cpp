#include "loading.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "check/check.hpp"
#include "diag/render.hpp"
#include "parse/parse.hpp"

namespace etlc::tests {

std::optional<check::Model> load(const std::string& text, const std::string& path) {
    const source::File file(path, text);
    diag::Sink sink;
    const ast::Spec spec = parse::parse(file, sink);
    std::optional<check::Model> model;
    if (!sink.has_errors()) model = check::check(spec, file, {}, sink);
    if (!model) ADD_FAILURE() << "the spec was refused:\n" << diag::render_text(file, sink) << text;
    return model;
}

std::string read_text(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    if (!stream) ADD_FAILURE() << path << " cannot be read";
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

}  // namespace etlc::tests
