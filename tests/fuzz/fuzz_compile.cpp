// Compiles specs of at most 10 KB through all stages and back ends: the result comes soon, and no
// text is out of proportion. Bytes that begin with "spec" are the spec; others choose a deep random
// one. libFuzzer's -timeout and replay.cpp limit the time of an input.
#include "deep_spec.hpp"
#include "diag/diag.hpp"
#include "driver/commands/commands.hpp"
#include "emit/emit.hpp"
#include "fuzz_target.hpp"

namespace {

using namespace etlc;

/// Many times the size of any useful result; a text that grows with the tree of a formula is far
/// larger.
constexpr std::size_t kMostText = 8'000'000;
constexpr std::size_t kMostMessage = 20'000;

void require_proportion(const source::File& file, const diag::Sink& sink) {
    for (const diag::Diagnostic& d : sink.sorted())
        fuzz::require(d.message.size() < kMostMessage, "a message has a sensible length");
    fuzz::require(diag::render_text(file, sink).size() < kMostText, "so have all of them");
    fuzz::require(diag::render_json(file, sink).size() < kMostText, "and as JSON");
}

void require_proportion(const std::string& output) {
    fuzz::require(output.size() < kMostText, "an output has a sensible length");
}

void compile(const source::File& file, check::Values values) {
    driver::Request request;
    request.values = values;
    diag::Sink sink;
    const auto compiled = etlc::compile(file, request.check, request, sink);
    fuzz::require(compiled.has_value() != sink.has_errors(), "there is a plan or an error");
    require_proportion(file, sink);
    if (!compiled) return;
    for (const emit::Backend& backend : emit::backends())
        require_proportion(backend.emit(compiled->plan, {"deep", "version", "", "targets.bin"}));
    require_proportion(ir::print(*compiled->program));
    require_proportion(plan::print(compiled->plan));
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    const std::string_view text = fuzz::text(bytes, size).substr(0, fuzz::kMostSpecBytes);
    const bool is_text = text.starts_with("spec");
    if (is_text && text.find("load") != std::string_view::npos) return 0;  // only files of the test
    const source::File file("a.etl", is_text ? std::string(text) : fuzz::deep_spec(bytes, size));
    compile(file, check::Values::robustness);
    compile(file, check::Values::boolean);
    return 0;
}
