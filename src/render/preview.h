/* A picture while it is being made, shown by a viewer that speaks the protocol of tev (github.com/Tom94/tev): packets CreateImage and
 * UpdateImage (version 3) over TCP. A thread of its own sends; who renders never waits for the viewer. */
#ifndef VTS_RENDER_PREVIEW_H
#define VTS_RENDER_PREVIEW_H

#include "base/strbuf.h"
#include "image/image.h"

typedef struct Preview Preview;

/* Whether this is "host:port", port 1 to 65535; "[::1]:14158" too. */
bool preview_address_valid(const char *address);
/* Connects within a second. NULL with a line in `why` (may be NULL) when nobody answers. */
Preview *preview_connect(const char *address, StrBuf *why);
/* The picture stays in the viewer. Of NULL: nothing. */
void preview_close(Preview *preview);

/* From now on `image` (R G B or R G B A, and whatever follows) is shown under this name, black at first. Its pixels must live until
 * preview_end(). Once. */
void preview_begin(Preview *preview, const char *name, const Image *image, int tile_count);
/* [x0, x1) × [y0, y1) of it is done, and does not change any more. From any thread; tile_count of them at most. */
void preview_tile(Preview *preview, int x0, int y0, int x1, int y1);
/* Waits until all has been sent, as long as the viewer takes it; less than a second where it does not, not at all where `at_once`. */
void preview_end(Preview *preview, bool at_once);

#endif
