/* What eye and light have in common: both look through the same gaps.
 *
 * Voxels tell how much of a light comes through a layer, not how much of it falls on what is seen: where the eye looks through a gap, along nearly the
 * same line the light does, too (the hot spot of remote sensing). How nearly, the gaps' correlation tells between directions a little apart. And of
 * matter in a layer that repeats along x and z the triangles tell which share of what is seen is lit, for pairs of 33 directions of the upper
 * hemisphere. */
#ifndef VTS_TEXEL_VOXEL_PAIRS_H
#define VTS_TEXEL_VOXEL_PAIRS_H

#include "texel/voxel_layer.h"
#include "texel/voxel_view.h"

/* The direction of a node, unit; and the nodes beside it: returns how many. */
enum { PAIR_MOST_NEIGHBOURS = PAIR_RING };
Vec3f pair_direction(int node);
int pair_neighbours(int node, int out[PAIR_MOST_NEIGHBOURS]);

/* The layer seen along a direction d, d.y > 0, over the plane y = 0. */
typedef struct PairView {
    float slope_x, slope_z; /* d / d.y */
    const ViewNormal *normal; /* of what is seen, or NULL */
    const float *top;       /* [grid × grid], along x first: height of what is met first from above; below 0 nothing */
} PairView;

/* What falls on the two sides of the matter that is seen: the side towards the eye, and the other. */
typedef struct PairShade {
    float facing[2]; /* |n · light| where the light falls on this side, else 0: its mean over all that is seen, were nothing in the light's way */
    float lit[2];    /* which share of that comes there */
    float sheets;    /* the share of facing[1] that is of sheets: walls of solids have no light on the other side */
    float all;       /* the share that lies open to the light of all that is seen, however it is turned */
} PairShade;
/* Sets layer->pairs.lit, and `shades` by direction to the eye, then to the light, from views along the directions of the nodes, with normals. `grid`: a power of two;
 * `size`: of the period along x and z; the middle of the first place is the same in all views. False if the pool was cancelled. */
bool voxel_layer_pair(VoxelLayer *layer, const PairView views[PAIR_NODES], int grid, const float size[2], PairShade shades[PAIR_NODES * PAIR_NODES], Pool *pool);
/* The share of the ground seen along a view that the light along another falls on, below 0 where none is seen: open[count × count], by eye, then by light.
 * `grid`: 8 at least. False without memory. */
bool pair_opens(const PairView *views, int count, int grid, float *open);
/* Views beside those of nodes, four at each height: which node's, and the direction, unit, `SPOT_ANGLE` radians from that of the node, the odd ones around the
 * zenith, the even ones towards it. */
enum { SPOT_KINDS = 4, SPOT_VIEWS = SPOT_KINDS * PAIR_HEIGHTS };
#define SPOT_ANGLE 0.1f
int pair_spot_node(int spot);
Vec3f pair_direction_beside(Vec3f d, bool around);
/* What is lit by a light beside the eye, as widths are told: of matter; of the ground, below 0 where none is seen, and the share of it that lies open to any light. */
typedef struct PairBeside {
    PairWidths lit, open, free;
} PairBeside;
/* views[PAIR_NODES + SPOT_VIEWS]; `size` as above; voxel_layer_pair() has been called. False without memory. */
bool pair_beside(const VoxelLayer *layer, const PairView *views, int grid, const float size[2], PairBeside *out);
/* Sets layer->pairs.glow and spot. */
void voxel_layer_find_peaks(VoxelLayer *layer, const PairBeside *beside);
/* The width, radians, for which of a peak from 1 down to the share `far` that much is left SPOT_ANGLE beside it. */
float pair_peak_width(float beside, float far);
/* As if nothing was known. */
void voxel_layer_forget_pairs(VoxelLayer *layer);
bool voxel_layer_is_paired(const VoxelLayer *layer);
/* Whether the numbers of a file are such as voxel_layer_pair() makes. */
bool voxel_pairs_are_sound(const VoxelPairs *pairs);

/* The entries of a table of pairs around two directions of any length, and their weights, which sum to 1. False below the horizon. */
enum { PAIR_CORNERS = 16 };
typedef struct PairPlace {
    int entry[PAIR_CORNERS];
    float weight[PAIR_CORNERS];
} PairPlace;
bool pair_place(Vec3f to_eye, Vec3f to_light, PairPlace *out);
/* The nodes around one direction of any length, and their weights, which sum to 1. False below the horizon. */
enum { PAIR_NODES_AROUND = 4 };
bool pair_nodes_around(Vec3f d, int node[PAIR_NODES_AROUND], float weight[PAIR_NODES_AROUND]);

/* Directions of texel space, of any length, to the eye and to the light, and widths like pairs.glow: how much of what is seen is lit for no other reason than
 * that: 1 where both are one, 0 where they have nothing in common or nothing is known, and where they are so far apart that the tables of pairs know it. */
float pair_peak(const PairWidths *width, Vec3f to_eye, Vec3f to_light);
/* The share that is lit of the matter that is seen; below 0 where that is not known. */
float voxel_layer_lit_pair(const VoxelLayer *layer, Vec3f to_eye, Vec3f to_light);

#endif
