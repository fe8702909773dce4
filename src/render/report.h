/* The report of a render (--report): what was asked, needed and built, and what it cost, as JSON. */
#ifndef VTS_RENDER_REPORT_H
#define VTS_RENDER_REPORT_H

#include "render/render.h"

typedef struct FrameReport {
    int frame;
    double clock;
    const char *output;
    double wall_s, cpu_s, parse_s, build_s, render_s, write_s, build_cpu_s;
    size_t peak_rss_bytes;
    const CompiledScene *compiled;
    const RenderStats *stats;
} FrameReport;

/* Adds a frame to those in `frames`, as JSON. */
void report_add_frame(StrBuf *frames, const FrameReport *frame);
/* The whole, of such frames. */
void report_write(StrBuf *out, const char *scene, const char *version, const StrBuf *frames);

#endif
