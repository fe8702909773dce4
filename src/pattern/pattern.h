/* Pigments and textures at a point, averaged over the footprint that is seen there.
 *
 * A footprint is the diameter, in units of the space the point is given in, of the disc about the point (across `normal`)
 * over which the colour is wanted; a zero normal means a ball, footprint 0 the point alone. Block and periodic patterns are
 * averaged exactly or nearly so, noises lose the octaves finer than the footprint; what they lose widens the piece of the
 * colour map that is averaged. All functions are pure and thread-safe. */
#ifndef VTS_PATTERN_PATTERN_H
#define VTS_PATTERN_PATTERN_H

#include "pattern/spot.h"
#include "scene/scene.h"

/* The colour at `point` of the textured object's space. `normal` (unit, or zero) is used by slope patterns too. */
Color pigment_color(const Pigment *pigment, Vec3 point, Vec3 normal, double footprint);
/* POV-Ray's scalar turbulence with the pigment's octaves, lambda, omega and noise. */
double pigment_turbulence(const Pigment *pigment, Vec3 point);
/* The pattern's value before the colour map, frequency, phase and wave applied: function { pattern { … } }. Block patterns
 * give the index of their entry (of checker and brick frequency, phase and wave are applied to it); PATTERN_SOLID and
 * PATTERN_AVERAGE give 0. */
double pigment_value(const Pigment *pigment, Vec3 point, Vec3 normal);
/* Whether the pigment has one colour everywhere, which *color gets. */
bool pigment_is_uniform(const Pigment *pigment, Color *color);
/* Whether the normal decides on its colour (`slope` somewhere in it); true where that takes too long to find out. */
bool pigment_follows_slope(const Pigment *pigment);

typedef struct SurfaceLook {
    Color color;          /* of all layers together; filter and transmit: what passes the lowest */
    const Finish *finish; /* of the topmost layer */
} SurfaceLook;

/* The point is in the textured object's space. */
SurfaceLook texture_look(const Texture *texture, Vec3 point, Vec3 normal, double footprint);

/* Where a ray met a surface, all of it in the scene's space: the input of textures in full. */
typedef struct SurfacePlace {
    Vec3 point;
    Vec3 normal;            /* unit, of the surface, or interpolated as a smooth triangle's: what normals perturb */
    double footprint;       /* diameter on the surface; 0: the point alone */
    Vec3 axes[2];           /* the footprint's two axes of full width along the surface, where known; else zero */
    const Transform *space; /* space of the textured object → scene; NULL: the same */
    SpotSurface surface;    /* the ray's direction, u and v */
} SurfacePlace;

/* One of the plain textures (with the layers under it) that a texture of a map is at a place. */
typedef struct TexturePart {
    const Texture *texture; /* topmost layer; walk `under` for the others */
    double weight;
    Spot spot;              /* in the space in which its maps stand */
    const Transform *space; /* from the texture's own to that space; NULL: the same */
    Mat3 linear;            /* vectors of that space → scene */
} TexturePart;

/* Resolves texture_map, material_map, uv_mapping and the like: at most `most` (at least 1) parts with weights that add up to 1, the
 * heaviest if there are more; a plain texture is one part. They point to `place`, which must outlive them. Returns how many. */
size_t texture_parts(const Texture *texture, const SurfacePlace *place, TexturePart *out, size_t most);
/* The pigment's colour of one layer of the part. `normal`: the perturbed one of the scene, for slope and aoi. */
Color texture_layer_color(const TexturePart *part, const Texture *layer, Vec3 normal);
/* The unit normal of the scene as the layer perturbs it, `normal` as it is without that. Bumps finer than this part of the footprint's width are smoothed. */
Vec3 texture_layer_normal(const TexturePart *part, const Texture *layer, Vec3 normal, double width);

/* Whether it lets light through nowhere, as far as can be told without looking everywhere. */
bool texture_is_opaque(const Texture *texture);
/* Whether it is the same at all places, as far as can be told from its text: solid colours without bumps. */
bool texture_is_even(const Texture *texture);
/* Whether it mirrors anywhere. */
bool texture_mirrors(const Texture *texture);

/* `top` laid over `below`. Light that comes back: top's own, where it is opaque, and what its filter lets through of the
 * layer below. */
Color color_over(Color top, Color below);

/* The sky sphere's layers, first below, over the background: opaque. `direction` is of unit length, footprint an angle in radians. */
Color sky_color(const Scene *scene, Vec3 direction, double footprint);

#endif
