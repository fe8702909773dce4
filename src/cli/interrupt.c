#include "cli/interrupt.h"

#include <signal.h>
#include <stdatomic.h>

/* A handler has no argument of ours: the one place where the program keeps state outside its functions. */
static _Atomic(VtsSession *) watched;
static volatile sig_atomic_t seen;

static void stop(int signal_number) {
    (void)signal_number;
    VtsSession *session = atomic_load(&watched);
    seen = 1;
    if (session) vts_interrupt(session);
}

void interrupt_watch(VtsSession *session) {
    atomic_store(&watched, session);
    if (seen) {
        if (session) vts_interrupt(session);
        return;
    }
    struct sigaction action = {.sa_handler = stop, .sa_flags = (int)SA_RESETHAND};
    sigemptyset(&action.sa_mask);
    struct sigaction ignore = {.sa_handler = SIG_IGN}; /* files that grow too large fail as on a full disk */
    sigaction(SIGXFSZ, &ignore, NULL);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

bool interrupt_seen(void) { return seen != 0; }
