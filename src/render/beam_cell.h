/* A cell of a skin, or a part of one, as a beam sees it. */
#ifndef VTS_RENDER_BEAM_CELL_H
#define VTS_RENDER_BEAM_CELL_H

#include "render/beam.h"
#include "render/skin.h"

/* q = c0 + c1·a + c2·b + c3·a·b + w·(c4 + c5·a + c6·b + c7·a·b), q.x, q.y and q.z. */
typedef struct CellFrame {
    const SkinCell *cell;            /* (a, b) from 0 to 1, whether it is a part or not */
    float x[8], y[8], z[8];
    Vec3f scene[8];                  /* the same in the scene, but for where it begins */
    float bend_ab, bend_aw, bend_bw; /* how far the middle of a line of texture space leaves its chord, for unit extents, scene units */
    bool affine;                     /* (u, v) → (a, b), and w' → w without a and b */
    double bent_a, bent_b;           /* (u, v) = those at a place + J·(da, db) + c3·da·db: J⁻¹·c3 at most */
    double a_u, a_v, a_0, b_u, b_v, b_0, w_w, w_0;
} CellFrame;

/* False where texture coordinates are singular: there is no way back from them. */
bool cell_frame(CellFrame *f, const Beam *beam, const SkinCell *cell);
/* Of (a, b, w). */
Vec3f cell_frame_point(const CellFrame *f, float a, float b, float w);
/* The same of many. */
void cell_frame_points(const CellFrame *f, int count, const float *restrict a, const float *restrict b, const float *restrict w, float *restrict x,
                       float *restrict y, float *restrict z);
/* How far the mapping bends at most what is so large in (a, b, w) out of its plane, scene units. */
static inline float cell_frame_bend(const CellFrame *f, float a, float b, float w) { return f->bend_ab * a * b + f->bend_aw * a * w + f->bend_bw * b * w; }
/* Whether it bends the edge from p to q by more than `tolerance`, scene units, out of its straight line, as its middle tells: that lies at `middle` in the cell,
 * half way between the two where texture coordinates are affine. The same in both directions, and in whatever beam. */
bool cell_frame_bends(const CellFrame *f, Vec3f p, Vec3f q, Vec3f middle, float tolerance);
/* The same of many edges, from (pa, pb, pw) to (qa, qb, qw), where texture coordinates are affine: bent[i] is 1 or 0. */
void cell_frame_bends_of(const CellFrame *f, int count, const float *restrict pa, const float *restrict pb, const float *restrict pw, const float *restrict qa,
                         const float *restrict qb, const float *restrict qw, float tolerance, uint32_t *restrict bent);
/* Takes the linear part of (u, v) → (a, b) at a place, or as near to it as the cell goes. */
void cell_frame_linearise(CellFrame *f, double u, double v);

double bilinear_at(const Bilinear *f, double a, double b);

/* Whether texture coordinates bend so little over the cell that Newton's method leads back from all of them. */
bool cell_is_tame(const SkinCell *cell);
/* Whether they lie on a line: there is no way back at all. */
bool cell_is_singular(const SkinCell *cell);
/* A quarter, 0 … 3, as a cell. The last of a triangle lies in its middle, turned about. */
SkinCell cell_quarter(const SkinCell *cell, int quarter);

/* A point of beam space that lies before the beam's near end has this in its outcode. */
enum { BEAM_TOO_NEAR = 16 };
/* In which of six ways points of beam space are out of the beam, a bit each. */
void beam_outcodes(const Beam *beam, int count, const float *restrict x, const float *restrict y, const float *restrict z, uint32_t *restrict codes);

typedef struct CellBox {
    float a0, a1, b0, b1, w0, w1;
} CellBox;

/* Narrows to the cell; false when nothing is left. */
bool cell_box_clip(const SkinCell *cell, CellBox *box);
/* Whether the beam may meet the box. *nearest gets the smallest q.z of a perspective beam, the negated largest of a parallel one. */
bool cell_box_met(const Beam *beam, const CellFrame *f, const CellBox *box, float *nearest);

/* A parallelogram of texture coordinates: middle, and halves of its sides; and a range of heights. */
typedef struct TextureBox {
    double u, v, side_u[2], side_v[2];
    double w0, w1;
} TextureBox;

/* A box around all places of the cell whose texture coordinates are in `in`; false when there certainly are none. */
bool cell_box_of(const CellFrame *f, const TextureBox *in, CellBox *box);

#endif
