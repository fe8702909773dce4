/* How a lamp shines by direction, as makers of lamps measure it. */
#ifndef VTS_SCENE_LAMP_H
#define VTS_SCENE_LAMP_H

#include "base/diag.h"
#include "base/hash.h"

enum { LAMP_MOST_ANGLES = 10000 }; /* of each of a table's sides */

/* Half planes through the lamp's axis, each with the same heights; light is interpolated in both angles. */
typedef struct LampTable {
    int height_count, turn_count;
    const double *heights; /* degrees from the axis, ascending; below and above them no light leaves the lamp */
    const double *turns;   /* degrees about the axis, ascending from 0 or 90; the rest follows from `period` and `mirrored` */
    const double *light;   /* [turn][height], of the brightest direction 1 */
    double period;         /* degrees after which it repeats itself; 0: it does not depend on the turn */
    bool mirrored;         /* the second half of a period is the first one's mirror image */
    Hash128 hash;
} LampTable;

/* Reads IESNA LM-63 (1986 to 2019) of photometric type C. What tilt, ballast and multiplier say changes all directions alike: it is checked, and makes
 * no difference. NULL after an error in `diags`, at its place in the file. The table lives in the arena. */
const LampTable *lamp_read(const SourceFile *file, DiagList *diags, Arena *arena);

/* 0 to 1; `height` from 0 to 180, `turn` any finite one, degrees. */
double lamp_light(const LampTable *lamp, double height, double turn);

#endif
