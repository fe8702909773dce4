/* All skins along a cone at once, each opened where the cone comes to it: of a wood of many copies only the first rows are ever followed. */
#ifndef VTS_RENDER_SKIN_FRONT_H
#define VTS_RENDER_SKIN_FRONT_H

#include "render/compile.h"

/* The marches of one worker: one for each skin of several cells, as these remember what they met last; skins of one cell, of which there may be
 * many thousands, share some. */
typedef struct SkinMarches {
    const CompiledScene *compiled;
    SkinMarch **own; /* by skin; NULL: of those that share */
    SkinMarch *shared;
    int shared_count;
} SkinMarches;

void skin_marches_init(SkinMarches *marches, const CompiledScene *compiled, int shared, Arena *arena);
/* The march of a skin, ready to begin; that of one without its own is number `slot`, and loses the skin that it followed. */
SkinMarch *skin_marches_get(const SkinMarches *marches, uint32_t skin, int slot);

/* A skin that the cone comes to, or one that was put off: from t on. */
typedef struct SkinAhead {
    uint32_t skin;
    double t;
    double from; /* where its march begins */
} SkinAhead;

typedef struct SkinOpen {
    uint32_t skin;
    int slot; /* −1: its march is its own */
    SkinMarch *march;
} SkinOpen;

typedef struct SkinFront {
    SkinMarches marches;
    const Cone *cone;
    double t_max;
    TraceCounters *counters;
    SkinMet *met;
    SkinAhead *ahead; /* by t, from ahead_first to ahead_end */
    size_t ahead_first, ahead_end;
    SkinOpen *open;
    SkinSegment *segments;
    size_t open_count;
    uint64_t free_slots; /* a bit for each */
    int coarser;
    size_t last;         /* of open: whose segment was handed out; none: SIZE_MAX */
} SkinFront;

void skin_front_init(SkinFront *front, const CompiledScene *compiled, TraceCounters *counters, Arena *arena);
/* Follows the cone up to t_max. `from` tells where the march through a skin begins; a skin of which it is not before t_max is left out. */
void skin_front_begin(SkinFront *front, const Cone *cone, double t_max, double (*from)(const CompiledSkin *skin, const void *context), const void *context);
/* The next segment, of all skins the nearest, until the next call; NULL when there is none. *march is its skin's, where the segment is the current one. */
const SkinSegment *skin_front_next(SkinFront *front, uint32_t *skin, const SkinMarch **march);
/* From here on voxels are so many levels coarser than fits the cone. */
void skin_front_coarsen(SkinFront *front, int levels);

#endif
