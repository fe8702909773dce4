/* The turtle that draws the words of L-systems (ABOP sec. 1.3, 1.5, 1.10, 5.1): segments of branches, polygons, and places where
 * letters stand for objects.
 *
 * It starts at the origin, heading +y, left −x, up +z. Of parameters the first counts.
 *   F(l) forward, drawing     f(l) forward       G(l) as F, but no corner of a polygon
 *   +(a) turn left            -(a) right         &(a) pitch down   ^(a) up   \(a) roll left   /(a) right   | turn round
 *   $ roll until left is horizontal              !(w) width w; without: times taper
 *   '(n) colour n; without: the next             [ ] branch        % leave out the rest of the branch
 *   { . } polygon: corners at . and where F and f arrive; the start of the first F or f is one too */
#ifndef VTS_GROW_TURTLE_H
#define VTS_GROW_TURTLE_H

#include "grow/lsystem.h"
#include "scene/scene.h"

typedef struct TurtleSettings {
    double angle;            /* of turns without parameter, degrees */
    double step, width, taper;
    Vec3 tropism;            /* after each segment the heading turns towards it by |heading × tropism| radians */
    const char *symbols;     /* letters that stand for objects */
} TurtleSettings;

/* Branches of one colour. */
typedef struct TurtleBranches {
    BranchNode *items;
    size_t count, capacity;
} TurtleBranches;

/* A letter that stands for an object: the object's y, −x and z are the turtle's heading, left and up. */
typedef struct TurtlePlace {
    char letter;
    double size;             /* the letter's parameter; 1 */
    Vec3 position, heading, left, up;
} TurtlePlace;

typedef struct TurtlePlaces {
    TurtlePlace *items;
    size_t count, capacity;
} TurtlePlaces;

/* Corners of polygons as triangles. */
typedef struct TurtleLeaves {
    struct { Vec3 *items; size_t count, capacity; } corners;
    struct { uint32_t (*items)[3]; size_t count, capacity; } triangles;
} TurtleLeaves;

enum { TURTLE_MOST_COLORS = 256 };

typedef struct TurtleDrawing {
    TurtleBranches branches[TURTLE_MOST_COLORS];
    TurtleLeaves leaves[TURTLE_MOST_COLORS];
    TurtlePlaces places;
    int colors;              /* numbers in use are below */
    size_t segments;
} TurtleDrawing;

/* Draws the word; everything in `arena`. Places that overflow are left out. */
void turtle_draw(const LSystemWord *word, const TurtleSettings *settings, Arena *arena, TurtleDrawing *out);

/* Whether the turtle itself has a meaning for the letter. */
bool turtle_knows(char letter);

#endif
