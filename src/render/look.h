/* How matter looks, ready for shading: texture and finish reduced to what the shader multiplies. */
#ifndef VTS_RENDER_LOOK_H
#define VTS_RENDER_LOOK_H

#include "render/ndf.h"
#include "scene/scene.h"

typedef struct Look {
    SheetLook sheet;
    Vec3f ambient, emission;
    float metallic;
    bool uniform;             /* one colour: `color` */
    Vec3f color;
    const Texture *texture;   /* never NULL */
    bool opaque;              /* light passes it nowhere */
    bool even;                /* the same everywhere: neither place nor u and v make a difference */
    bool plain;               /* opaque, mirrors nothing, one layer: no line of sight goes on from it */
} Look;

Look look_from_texture(const Texture *texture, const GlobalSettings *settings);
/* Pigment at a point of the space that the texture's object lives in; footprint in the same space. */
Vec3f look_color(const Look *look, Vec3 point, Vec3 normal, double footprint);
static inline Vec3f vec3f_from_color(Color c) { return vec3f((float)c.red, (float)c.green, (float)c.blue); }

#endif
