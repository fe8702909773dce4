/* Lines of sight and of light through POV-Ray's media. */
#ifndef VTS_RENDER_MEDIA_H
#define VTS_RENDER_MEDIA_H

#include "render/surface.h"

/* What the media that the leg is in make of what is seen at t_max along it: of interiors first, and the scene's own before them. Within what is
 * not hollow there are none. */
Air media_air(SurfaceTracer *tracer, const Leg *leg, double t_max);

/* The share of light that passes the media of these objects between t0 and t1 of the ray of unit direction; slack: SurfaceTracer.media_slack. */
Vec3f media_passing(const CompiledScene *compiled, const Enclosure *enclosures, int count, const Ray *ray, double t0, double t1, double slack);
/* and that passes the scene's own. */
Vec3f media_air_passing(const CompiledScene *compiled, const Ray *ray, double distance, double slack);

/* ---- media_matter.c: what is there along a ray ---- */

/* A medium, seen from a ray. */
typedef struct MediumSite {
    const Medium *medium;
    Ray ray;       /* in its space, same t */
    double t0, t1; /* where its density may be something */
    double stride; /* how far apart places are that tell of all in between; infinite where it is even */
} MediumSite;

enum { MEDIA_MOST_SITES = 96 };
typedef struct MediaMatter {
    MediumSite sites[MEDIA_MOST_SITES]; /* of more the rest is left out */
    int count;
    double t0, t1; /* of all */
} MediaMatter;

void media_matter_begin(MediaMatter *matter, double t0, double t1);
/* Adds those that are on the ray; `to_space`: scene → their space, or NULL for the same. */
void media_matter_add(MediaMatter *matter, const MediaList *media, const Affine *to_space, const Ray *ray);
/* The medium's density at t, colour by colour. */
Vec3 medium_density(const MediumSite *site, double t);
/* What light that goes on at t loses for each unit of length. */
Vec3 media_extinction(const MediaMatter *matter, double t);

enum { MEDIA_MOST_STOPS = 640 };
/* Places between which the matter is told by a few: ascending from t0 to t1, `extra` ones among them. Returns how many. */
int media_stops(const MediaMatter *matter, const double *extra, int extra_count, double stops[MEDIA_MOST_STOPS]);

#endif
