/* The report of a render (--report): what was asked, needed and built, and what it cost, as JSON. */
#ifndef VTS_RENDER_REPORT_H
#define VTS_RENDER_REPORT_H

#include "render/render.h"

typedef struct FrameReport {
    int frame;
    double clock;
    const char *output;
    double wall_s, cpu_s, parse_s, build_s, render_s, write_s;
    size_t peak_rss_bytes;
    const CompiledScene *compiled;
    const RenderStats *stats;
} FrameReport;

void report_write(StrBuf *out, const char *scene, const char *version, const FrameReport *frames, size_t count);

#endif
