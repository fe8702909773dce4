/* What the light pass of volumes has left, kept from one frame to the next where nothing but the camera moves. */
#ifndef VTS_RENDER_VOLUME_MEMO_H
#define VTS_RENDER_VOLUME_MEMO_H

#include "render/compile.h"

typedef struct VolumeMemo VolumeMemo;

/* Empty; NULL when memory is short. */
VolumeMemo *volume_memo_create(void);
void volume_memo_destroy(VolumeMemo *memo);

/* volumes_light(), or what it left for the same scene as compiled->options->volume_memo (NULL: none) has it; that of one scene is kept. False when
 * interrupted. */
bool volumes_light_kept(CompiledScene *compiled);

#endif
