/* First changes of sign by bounds of several pieces at once (tape_lanes.h): a piece is divided into as many as there are lanes, what
 * remains of each waits in order. As many bounds as halving takes on the same way, and a fraction of the time. */
#include "shape/line_parts.h"

#include <stdlib.h>

enum { AHEAD = 2 /* pieces divided together */, FEW_LANES = 24 };

/* Pieces up to this many line_shortest() are left to halving, whose bounds' roundings are smaller. */
static const double ALONE = 0x1p6;

typedef struct Lanes {
    LineSearch *search;
    AffineLanes *scratch;
    LinePiece stack[LINE_MOST_PIECES];
    int count;
} Lanes;

static void place_lanes(const Line *line, const LinePiece *pieces, AffineLanes in[3], AffineLanes *width) {
    const double origin[3] = {line->origin.x, line->origin.y, line->origin.z},
                 along[3] = {line->direction.x, line->direction.y, line->direction.z};
    for (int k = 0; k < 3; k++) AFFINE_EACH_LANE {
            double middle = pieces[l].a / 2 + pieces[l].b / 2,
                   half = (pieces[l].b - pieces[l].a) / 2 * (1 + 0x1p-50);
            double size = fabs(origin[k]) + (fabs(middle) + half) * fabs(along[k]);
            in[k].centre[l] = origin[k] + middle * along[k], in[k].slope[l] = half * along[k],
            in[k].error[l] = affine_lane_error(0, size);
        }
    AFFINE_EACH_LANE {
        double middle = pieces[l].a / 2 + pieces[l].b / 2, half = (pieces[l].b - pieces[l].a) / 2 * (1 + 0x1p-50);
        double size = line->width.start + (fabs(middle) + half) * line->width.spread;
        width->centre[l] = line->width.start + middle * line->width.spread, width->slope[l] = half * line->width.spread;
        width->error[l] = affine_lane_error(0, size);
    }
}

/* A bit for each lane that may be 0 or is unknown. */
static uint64_t open_lanes(const AffineLanes *bounds) {
    uint64_t open = 0;
    AFFINE_EACH_LANE {
        /* Infinite, or no number, where nothing is known. */
        double radius = (fabs(bounds->slope[l]) + bounds->error[l]) * (1 + 0x1p-50);
        open |= fabs(bounds->centre[l]) > radius ? 0 : (uint64_t)1 << l;
    }
    return open;
}

/* What may hold a zero of the pieces, cut, goes onto the stack, the first on top. */
static void push_rest(Lanes *lanes, const LinePiece *pieces, const AffineLanes *bounds, int used) {
    uint64_t open = open_lanes(bounds);
    for (int l = used; l-- > 0;) {
        if (!(open >> l & 1)) continue;
        LinePiece piece = pieces[l];
        AffineForm f = affine_lane(bounds, l);
        if (!(f.error < HUGE_VAL)) {
            f = line_bounds(lanes->search, piece.a, piece.b);
            Interval range = affine_range(f);
            if (range.low > 0 || (range.high <= 0 && !f.nan)) continue;
        }
        if (!f.nan) line_cut(f, &piece.a, &piece.b);
        if (!(piece.b >= piece.a) || lanes->count >= LINE_MOST_PIECES) continue;
        lanes->stack[lanes->count++] = piece;
    }
}

/* The first pieces of the stack, taken together: each is divided into as many parts as there are lanes for it. */
static void divide(Lanes *lanes, const LinePiece *wholes, int count) {
    LinePiece pieces[AFFINE_LANES];
    AffineLanes bounds, width;
    const Line *line = lanes->search->line;
    int shares = AFFINE_LANES / count, used = 0;
    for (int k = 0; k < count; k++) {
        double a = wholes[k].a, b = wholes[k].b, step = (b - a) / shares;
        for (int l = 0; l < shares; l++)
            pieces[used++] = (LinePiece){l ? a + step * l : a, l < shares - 1 ? a + step * (l + 1) : b};
    }
    for (int l = used; l < AFFINE_LANES; l++) pieces[l] = pieces[used - 1];
    place_lanes(line, pieces, lanes->scratch, &width);
    tape_sum_lanes(line->sum, line->level, line_is_wide(line) ? &width : NULL, &bounds, lanes->scratch);
    lanes->search->work.bounds += (uint64_t)used;
    push_rest(lanes, pieces, &bounds, used);
}

static bool search(Lanes *lanes, double *t, bool *falling) {
    LineSearch *s = lanes->search;
    while (lanes->count > 0) {
        LinePiece wholes[AFFINE_LANES];
        int count = 0;
        while (count < AHEAD && lanes->count > 0) {
            LinePiece piece = lanes->stack[lanes->count - 1];
            bool full = lanes->count + AFFINE_LANES > LINE_MOST_PIECES || s->work.bounds > LINE_MOST_BOUNDS;
            if (count > 0 && (full || piece.b - piece.a < 0x1p-20 * (fabs(piece.a) + fabs(piece.b)))) break;
            lanes->count--;
            if (full) {
                if (line_give_up(s, piece, t, falling)) return true;
            } else if (piece.b - piece.a <= ALONE * line_shortest(s->line, piece.b)) {
                if (line_search_halves(s, piece.a, piece.b, t, falling)) return true;
            } else {
                wholes[count++] = piece;
            }
        }
        if (count > 0) divide(lanes, wholes, count);
    }
    return false;
}

bool line_search_lanes(LineSearch *s, double from, double to, double *t, bool *falling) {
    AffineLanes few[FEW_LANES];
    size_t slots = s->line->sum->scratch_size;
    Lanes lanes = {.search = s, .scratch = slots > FEW_LANES ? malloc(slots * sizeof *few) : few, .count = 1};
    if (!lanes.scratch) return false;
    lanes.stack[0] = (LinePiece){from, to};
    bool found = search(&lanes, t, falling);
    if (lanes.scratch != few) free(lanes.scratch);
    return found;
}
