/* Going on with a picture that another run has begun. */
#include "vts_session.h"

#include "base/hash.h"

#include <string.h>

/* A picture that takes less is drawn again, and no file is written for it. */
static const double WORTH_KEEPING = 10;

/* Also of the sky light's and other files' contents no more is known than their names: they stand in the texts. */
static TileFileKey key_of(const VtsSession *session, bool exact) {
    const VtsOptions *o = &session->options;
    TileFileKey key = {.picture = session_key(session, exact),
                       .channels = (o->alpha ? 4 : 3) + (o->aovs ? session->aovs.channels : 0)};
    int region[4];
    memcpy(region, o->region, sizeof region);
    if (region[2] == 0) region[2] = o->width, region[3] = o->height;
    for (int i = 0; i < 4; i++) key.region[i] = region[i];
    key.tiles = (uint32_t)film_tiles_x(region) * (uint32_t)film_tiles_y(region);
    return key;
}

void session_keep_tiles(VtsSession *session, const char *output_path, bool exact) {
    const VtsOptions *o = &session->options;
    if (o->shutter_clock != 0 || o->shutter_time != 0) return; /* what is done of a moment is little */
    TileFileKey key = key_of(session, exact);
    session->kept = tile_file_open(output_path, &key, o->resume, o->resume ? 0 : WORTH_KEEPING);
}
