/* What tracing tells of what it meets, for further channels. */
#include "render/aov_trace.h"

#include <string.h>

AovSample aov_of_surface(const Cone *cone, const SurfaceHit *hit, float share) {
    Vec3 point = cone_point(cone, hit->t), local = transform_point_back(&hit->space, point);
    Vec3 local_normal = vec3_normalize(mat3_apply_transposed(&hit->space.linear, hit->normal));
    double shrink = cbrt(fabs(mat3_determinant(&hit->space.inverse_linear)));
    return (AovSample){.share = share,
                       .depth = hit->t,
                       .position = point,
                       .normal = vec3f_from(hit->normal),
                       .albedo = look_color(hit->look, local, local_normal, cone_diameter(cone, hit->t) * shrink),
                       .u = (float)hit->uv.u,
                       .v = (float)hit->uv.v,
                       .object = hit->number,
                       .level = -1};
}

void matter_sum_begin(MatterAov *sum) { memset(sum, 0, sizeof *sum); }

static double level_of(const MatterHit *hit, float voxel_width) {
    double level = hit->texel->voxel > 0 ? log2(fmax((double)(hit->width * voxel_width / hit->texel->voxel), 1)) : 0;
    return fmin(level, hit->texel->levels - 1);
}

void matter_sum_add(MatterAov *sum, const SkinSegment *segment, float weight, float voxel_width) {
    sum->share += weight;
    sum->depth += (double)weight * (segment->t0 + segment->t1) / 2;
    for (int i = 0; i < segment->hit_count; i++) {
        const MatterHit *hit = &segment->hits[i];
        float share = weight * hit->share;
        sum->normals = sym3f_madd(&sum->normals, &hit->s, share);
        sum->level += (double)share * level_of(hit, voxel_width);
    }
}

AovSample matter_sum_end(const MatterAov *sum, const Cone *cone) {
    AovSample seen = {.share = sum->share};
    if (!(sum->share > 0)) return seen;
    float values[3];
    Vec3f axes[3], eye = vec3f_from(vec3_negate(cone->direction));
    sym3f_eigen(&sum->normals, values, axes);
    seen.normal = vec3f_dot(axes[0], eye) < 0 ? vec3f_scale(axes[0], -1) : axes[0];
    seen.depth = sum->depth / (double)sum->share;
    seen.position = cone_point(cone, seen.depth);
    seen.albedo = vec3f_scale(sum->albedo, 1 / sum->share);
    seen.level = (float)(sum->level / (double)sum->share);
    return seen;
}
