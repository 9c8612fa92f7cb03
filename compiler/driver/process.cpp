#include "driver/process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include "data/descriptor.hpp"

namespace etlc::driver {

void prepare_process() {
    ::signal(SIGXFSZ, SIG_IGN);
    // The lowest number that is free is the one that open() gives.
    for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(standard, F_GETFD) < 0) static_cast<void>(::open("/dev/null", standard == STDERR_FILENO ? O_WRONLY : O_RDONLY));
}

bool print_error(std::string_view text) {
    return data::write_all(STDERR_FILENO, text);
}

}  // namespace etlc::driver
