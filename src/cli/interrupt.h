/* SIGINT and SIGTERM stop the running session; a second one stops the program at once. */
#ifndef VTS_CLI_INTERRUPT_H
#define VTS_CLI_INTERRUPT_H

#include "vts.h"

/* From now on signals go to this session; NULL: to none, but they are remembered. */
void interrupt_watch(VtsSession *session);
/* Whether a signal has come. */
bool interrupt_seen(void);

#endif
