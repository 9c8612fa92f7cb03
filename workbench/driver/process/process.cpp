#include "driver/process/process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <new>

#include "data/files/file.hpp"
#include "data/spill/spill.hpp"
#include "diag/render.hpp"

namespace etlc::driver {

namespace {

constexpr std::string_view kNoMemory = "etlc: there is not enough memory\n";

}  // namespace

int say_what_failed() noexcept {
    try {
        throw;
    } catch (const std::bad_alloc&) {
        print_error(kNoMemory);
        return kFailed;
    } catch (const data::SpillError& error) {
        for (const std::string_view part : {"etlc: ", error.what(), "\n"}) print_error(part);
        return kFailed;
    } catch (const std::exception& error) {
        for (const std::string_view part : {"etlc: internal error: ", error.what(), "\n"})
            print_error(part);
    } catch (...) {
        print_error("etlc: internal error\n");
    }
    return kOwnFault;
}

namespace {

/// Ends the process in std::terminate. Some noexcept functions of libraries allocate memory:
/// destructors of nlohmann::json, iterators of std::filesystem. An exception that leaves one is not
/// the current exception, and can only be std::bad_alloc.
[[noreturn]] void end() noexcept {
    if (std::current_exception()) ::_exit(say_what_failed());
    if (std::uncaught_exceptions() == 0) ::abort();
    print_error(kNoMemory);
    ::_exit(kFailed);
}

}  // namespace

void prepare_process() {
    std::set_terminate(end);
    ::signal(SIGXFSZ, SIG_IGN);
    // open() returns the lowest free descriptor.
    for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(standard, F_GETFD) < 0)
            static_cast<void>(::open("/dev/null", standard == STDERR_FILENO ? O_WRONLY : O_RDONLY));
}

bool print_error(std::string_view text) {
    return data::write_all(STDERR_FILENO, text);
}

int conclude(const std::string& form, const source::File& file, const diag::Sink& sink) {
    const auto colour = isatty(STDERR_FILENO) != 0 ? diag::Colour::ansi : diag::Colour::none;
    const bool printed = print_error(form == "json" ? diag::render_json(file, sink)
                                                    : diag::render_text(file, sink, colour));
    return sink.refused() || !printed ? kFailed : kDone;
}

}  // namespace etlc::driver
