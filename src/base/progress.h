/* How far a long piece of work is, told to whoever wants to show it. */
#ifndef VTS_BASE_PROGRESS_H
#define VTS_BASE_PROGRESS_H

#include "base/common.h"

typedef struct Progress {
    /* stage: "texel Grass", "render" …; done of total steps. Called from any worker, one at a time, and cheaply often:
     * the receiver limits how often it draws. NULL: nobody listens. */
    void (*update)(void *context, const char *stage, size_t done, size_t total);
    void *context;
} Progress;

static inline void progress_update(const Progress *progress, const char *stage, size_t done, size_t total) {
    if (progress && progress->update) progress->update(progress->context, stage, done, total);
}

#endif
