#include "driver/process/telling.hpp"

#include <unistd.h>

#include "diag/render.hpp"
#include "driver/process/process.hpp"

namespace etlc::driver {

int conclude(const std::string& form, const source::File& file, const diag::Sink& sink) {
    const auto colour = isatty(STDERR_FILENO) != 0 ? diag::Colour::ansi : diag::Colour::none;
    const bool told = print_error(form == "json" ? diag::render_json(file, sink)
                                                 : diag::render_text(file, sink, colour));
    return sink.refused() || !told ? kFailed : kDone;
}

}  // namespace etlc::driver
