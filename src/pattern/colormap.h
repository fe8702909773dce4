/* Colour maps: a piecewise linear function of the pattern's value, and its means over intervals. */
#ifndef VTS_PATTERN_COLORMAP_H
#define VTS_PATTERN_COLORMAP_H

#include "pattern/values.h"

typedef struct ColorMap {
    const ColorMapEntry *entries;
    size_t count;
} ColorMap;

/* The pigment's map, or POV-Ray's own for the pattern where it has none. */
ColorMap colormap_of(const Pigment *pigment);
ColorMap colormap_own(PatternKind kind);

/* Between two entries: `share` of that above. */
typedef struct MapPlace {
    size_t below, above;
    double share;
} MapPlace;

/* Whether wave and map are straight over the values from `lo` to `hi`, so that whatever is spread over these has the colour of its mean, which is
 * `mean`: most footprints are smaller than what a map shows. */
bool colormap_is_straight(const Pigment *pigment, ColorMap map, double lo, double hi, double mean, MapPlace *place);

/* Pieces of the range of values, each filled uniformly; weights add up to 1. */
enum { MAX_PIECES = 32 };
typedef struct MapPieces {
    struct {
        double lo, hi, weight;
    } items[MAX_PIECES];
    int count;
} MapPieces;

/* The values, after the pattern's restart, the pigment's frequency and phase and the wave, that `spread` stands for. */
MapPieces colormap_pieces(const Pigment *pigment, Spread spread);
/* Called with the number of an entry of the pattern and its share; shares add up to 1. Numbers of block patterns may go past
 * the entries that the pattern has. */
typedef void BlendVisit(void *target, size_t entry, double share);
/* The entries that have a part in the mean over the pieces, for each piece in their order; shares add up to `share`. */
void colormap_blend(ColorMap map, const MapPieces *pieces, double share, BlendVisit *visit, void *target);

#endif
