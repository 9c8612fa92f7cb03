/* A spec that is opened when the program starts: prints how many monitors it has. */
#include <etlc.h>
#include <stdio.h>

int main(int argc, char** argv) {
    etlc_options options = ETLC_OPTIONS;
    options.path = argc == 2 ? argv[1] : NULL;
    etlc_session session;
    etlc_description spec = {.struct_size = sizeof spec};
    if (etlc_open(&options, &session) != ETLC_OK || etlc_describe(session, &spec) != ETLC_OK) {
        printf("%s\n", etlc_message());
        return 1;
    }
    printf("%s: monitors: %u\n", spec.name, spec.monitors);
    return etlc_close(session) == ETLC_OK ? 0 : 1;
}
