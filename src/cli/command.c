#include "cli/command.h"

#include "cli/complaint.h"
#include "cli/interrupt.h"

#include <stdio.h>

/* Whatever the session did not say through its callback. */
static void explain(const Settings *settings, const Console *console, const VtsSession *session,
                    const char *scene, VtsStatus status) {
    const char *text = vts_diagnostics(session);
    if (status == VTS_INTERRUPTED)
        complain(settings, "interrupted");
    else if (status == VTS_OK || console->diagnostics_shown)
        return;
    else if (status == VTS_ERROR_USAGE && (!text || !*text))
        return; /* about the command line: told already */
    else if (text && *text)
        fputs(text, stderr);
    else
        complain(settings, "'%s' failed", scene);
}

int command_with_session(Settings *settings, Console *console, const char *scene, SessionCall *call,
                         const void *context) {
    const char *error = NULL;
    console_attach(console, &settings->options);
    VtsSession *session = vts_session_create(&settings->options, &error);
    if (!session) return complain_usage(settings, "%s", error ? error : "a session cannot be made");
    interrupt_watch(session);
    VtsStatus status = interrupt_seen() ? VTS_INTERRUPTED : call(session, context);
    interrupt_watch(NULL);
    console_clear(console);
    explain(settings, console, session, scene, status);
    vts_session_destroy(session);
    return (int)status;
}
