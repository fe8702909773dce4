#include "render/integrate.h"

#include "base/random.h"
#include "render/matter_color.h"
#include "render/skin_joint.h"
#include "render/volume_set.h"

#include <string.h>

/* Matter of one look in some segments on end. Sums over what is met, weighted by its share of the pixel. */
typedef struct MatterSum {
    const Look *look;
    float weight;
    float sky;   /* that is seen */
    Vec3f color; /* pigment */
    Sym3f s;
} MatterSum;
enum { MOST_MATTER_SUMS = MOST_MATTER_HITS };

/* Segments on end, which are shaded as one. */
typedef struct Group {
    float weight;
    double t, voxel_world; /* sums, weighted */
    uint32_t skin;         /* of the last segment, and the place of its middle there */
    SkinPoint point;
    SkinJoint joint;       /* at the first segment */
    MatterSum sums[MOST_MATTER_SUMS];
    int sum_count;
} Group;

/* A group, shaded but for shadows. */
struct ShadeRecord {
    float weight;     /* of its segments: transmittance before × opacity */
    double t;
    double tolerance; /* of finding the place in the skin again */
    uint32_t skin;
    SkinPoint point;  /* where shadows start: a guess */
    Vec3f glow;       /* light that nothing takes away; as that of lights it includes the weight */
    Vec3f ambient;    /* that only the sky's shadows take away; as that of lights it includes the weight */
};
/* Groups of less weight than this go on growing: where little is seen, little is shaded. */
static const float GROUP_WEIGHT = 1.0f / 24;
/* Below these transmittances voxels are one level coarser, and another: what is seen through much matter needs less. */
static const float COARSER_BELOW[] = {0.3f, 0.08f};

/* Light that shadows could take away is tested where it makes more than this of a pixel. */
static const float SHADOW_WORTH = 1.0f / 512;
enum { MOST_SHADOW_POINTS = 2 };
/* Between the first matter that is seen and what lies deeper light may fall to nothing: of so much light one shadow in the middle is not enough. */
static const float SHADOWS_PER_LIGHT = 100;
/* Less visibility than this does not tell how it falls. */
static const float DARKEST_OF_FALL = 0.002f;

void tracer_init(Tracer *tracer, const CompiledScene *compiled, Arena *arena) {
    *tracer = (Tracer){.compiled = compiled,
                       .records = arena_new_array(arena, ShadeRecord, MOST_SHADE_RECORDS),
                       .direct = arena_new_array(arena, Vec3f, MOST_SHADE_RECORDS * (compiled->scene->light_count + 1)),
                       .light_rays = arena_new_array(arena, LightRay, compiled->scene->light_count)};
    skin_front_init(&tracer->front, compiled, &tracer->counters, arena);
    skin_light_init(&tracer->light, compiled, &tracer->counters, arena);
}

/* ---- matter of skins ---- */

/* Members of a family hold the same leaves. */
static bool shaded_alike(const Look *a, const Look *b) { return a->texture == b->texture; }

static MatterSum *sum_of(Group *group, const Look *look) {
    for (int i = 0; i < group->sum_count; i++)
        if (shaded_alike(group->sums[i].look, look)) return &group->sums[i];
    if (group->sum_count == MOST_MATTER_SUMS) return &group->sums[MOST_MATTER_SUMS - 1];
    MatterSum *sum = &group->sums[group->sum_count++];
    *sum = (MatterSum){.look = look};
    return sum;
}

static void group_add(Group *group, const Cone *cone, const SkinMarch *march, const SkinSegment *segment, float weight) {
    double middle = (segment->t0 + segment->t1) / 2;
    float voxel_width = march->settings->voxel_width;
    group->point = skin_march_guess(march, middle);
    if (!(group->weight > 0)) skin_joint_find(march, &group->joint);
    group->weight += weight;
    group->t += (double)weight * middle;
    group->voxel_world += (double)(weight * segment->voxel_world);
    for (int i = 0; i < segment->hit_count; i++) {
        const MatterHit *hit = &segment->hits[i];
        MatterSum *sum = sum_of(group, hit->look);
        float share = weight * hit->share;
        sum->weight += share;
        sum->sky += share * hit->sky;
        sum->color = vec3f_madd(sum->color, vec3f_mul(matter_color(hit, cone, middle, voxel_width), hit->tint), share);
        sum->s = sym3f_madd(&sum->s, &hit->s, share);
    }
}

/* What the voxels of a skin make of a light on a sheet of theirs. */
static SheetLook look_in_light(const SheetLook *sheet, const float factor[2]) {
    SheetLook look = *sheet;
    look.diffuse *= factor[0];
    look.transmission *= factor[1];
    return look;
}

/* Shades a group for all lights: `direct`; and with its own light and the ambient. */
static void shade_group(const Tracer *tr, const Cone *cone, const Group *group, const LightRay *rays, ShadeRecord *record, Vec3f *direct) {
    size_t lights = tr->compiled->scene->light_count;
    Vec3f ambient = {0, 0, 0}, glow = {0, 0, 0}, view = vec3f_from(vec3_negate(cone->direction));
    memset(direct, 0, lights * sizeof *direct);
    for (int i = 0; i < group->sum_count; i++) {
        const MatterSum *sum = &group->sums[i];
        if (!(sum->weight > 0)) continue;
        Vec3f color = vec3f_scale(sum->color, 1 / sum->weight);
        ambient = vec3f_madd(ambient, vec3f_mul(sum->look->ambient, color), sum->sky);
        glow = vec3f_madd(glow, vec3f_mul(sum->look->emission, color), sum->weight);
    }
    for (size_t l = 0; l < lights; l++) {
        float factor[2] = {1, 1};
        if (!tr->compiled->scene->lights[l].shadowless) skin_joint_facing(&group->joint, vec3_negate(cone->direction), rays[l].direction, factor);
        for (int i = 0; i < group->sum_count; i++) {
            const MatterSum *sum = &group->sums[i];
            if (!(sum->weight > 0)) continue;
            SheetLook sheet = look_in_light(&sum->look->sheet, factor);
            NdfShade shade = ndf_shade(tr->compiled->quadrature, &sum->s, view, vec3f_from(rays[l].direction), &sheet);
            Vec3f tone = light_tone(&rays[l], &shade, sum->look, vec3f_scale(sum->color, 1 / sum->weight));
            direct[l] = vec3f_madd(direct[l], tone, sum->weight);
        }
    }
    record->ambient = ambient;
    record->glow = glow;
}

/* Makes a record of the group and empties it. */
static void close_group(Tracer *tr, const Cone *cone, Group *group, ShadeRecord *record, Vec3f *direct) {
    const Scene *scene = tr->compiled->scene;
    double t = group->t / (double)group->weight;
    Vec3 point = cone_point(cone, t);
    for (size_t l = 0; l < scene->light_count; l++) {
        tr->light_rays[l] = light_ray(&scene->lights[l], point);
        if (!light_shines_on(&scene->lights[l], NULL)) tr->light_rays[l].color = vec3f(0, 0, 0);
    }
    *record = (ShadeRecord){.weight = group->weight, .t = t, .tolerance = 0.02 * group->voxel_world / (double)group->weight,
                            .skin = group->skin, .point = group->point};
    shade_group(tr, cone, group, tr->light_rays, record, direct);
    for (int i = 0; tr->matter && i < group->sum_count; i++) tr->matter->albedo = vec3f_add(tr->matter->albedo, group->sums[i].color);
    *group = (Group){0};
}

/* ---- from exact geometry to voxels ---- */

/* What is left of the light behind the segments so far, for each of the cone's starts. */
typedef struct Passed {
    const ConeStart *start;
    float through[MOST_CONE_STARTS]; /* one, where the cone has no starts */
    float transmittance;             /* their mean */
} Passed;

static Passed passed_nothing(const ConeStart *start) {
    Passed passed = {.start = start, .transmittance = 1};
    for (int i = 0; i < MOST_CONE_STARTS; i++) passed.through[i] = 1;
    return passed;
}

static double march_start(const CompiledSkin *skin, const void *context) {
    const ConeStart *start = context;
    return skin->boxes && start->count ? skin->exact_to * (double)start->factor[0] : 0;
}

/* Takes the segment out of what is left; returns how much of the pixel it hides. Each start has its own transmittance: the mean of
 * those, not of depths, is what its samples would see. */
static float pass_segment(Passed *passed, const CompiledSkin *skin, const SkinSegment *segment) {
    const ConeStart *start = passed->start;
    float before = passed->transmittance;
    if (!start->count) {
        passed->transmittance *= segment->transmittance;
        return before - passed->transmittance;
    }
    double t = (segment->t0 + segment->t1) / 2;
    passed->transmittance = 0;
    for (int i = 0; i < start->count; i++) {
        if (!skin->boxes || skin->exact_to * (double)start->factor[i] < t) passed->through[i] *= segment->transmittance;
        passed->transmittance += start->share[i] * passed->through[i];
    }
    return float_max(0, before - passed->transmittance);
}

/* Follows the cone through all skins at once, nearest segment first; returns how many records were made. */
static size_t gather(Tracer *tr, const Cone *cone, const ConeStart *start, double t_max, float *transmittance) {
    const CompiledScene *scene = tr->compiled;
    size_t stride = scene->scene->light_count + 1, count = 0;
    const SkinSegment *segment;
    const SkinMarch *march;
    uint32_t skin;
    Group group = {0};
    int coarser = 0;
    Passed passed = passed_nothing(start);
    skin_front_begin(&tr->front, cone, t_max, march_start, start);
    while (count < MOST_SHADE_RECORDS && passed.transmittance > scene->opaque_below && (segment = skin_front_next(&tr->front, &skin, &march)) != NULL) {
        if (group.weight > 0 && (skin != group.skin || group.weight > GROUP_WEIGHT)) {
            close_group(tr, cone, &group, &tr->records[count], &tr->direct[count * stride]);
            count++;
        }
        group.skin = skin;
        float hidden = pass_segment(&passed, &scene->skins[skin], segment);
        if (hidden > 0) group_add(&group, cone, march, segment, hidden);
        if (hidden > 0 && tr->matter) matter_sum_add(tr->matter, segment, hidden, scene->march.voxel_width);
        if (coarser < (int)VTS_ARRAY_COUNT(COARSER_BELOW) && passed.transmittance < COARSER_BELOW[coarser]) skin_front_coarsen(&tr->front, ++coarser);
    }
    if (group.weight > 0 && count < MOST_SHADE_RECORDS) {
        close_group(tr, cone, &group, &tr->records[count], &tr->direct[count * stride]);
        count++;
    }
    *transmittance = passed.transmittance;
    return count;
}

static float luminance(Vec3f c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

static float record_visibility(Tracer *tr, const Light *light, const Cone *cone, const ShadeRecord *r) {
    if (light_comes_everywhere(light)) return 1;
    const CompiledScene *scene = tr->compiled;
    Vec3 point = cone_point(cone, r->t), to_eye = vec3_negate(cone->direction);
    LightRay ray = light_ray(light, point);
    tr->counters.shadow_rays++;
    Ray explicit_ray = {point, ray.direction};
    float clear = 1;
    if (!scene->clear_shadows) {
        if (hierarchy_occluded(scene->hierarchy, &explicit_ray, r->tolerance, ray.distance)) return 0;
    } else { /* of what is clear on the way the mean of the colours */
        SurfaceTracer surfaces = {.compiled = scene, .counters = &tr->counters, .seed = tr->seed};
        Leg leg;
        surface_eye_leg(tr->compiled, cone, &leg);
        Vec3f passed = surface_shadow(&surfaces, light, &ray, &leg, point, r->tolerance, tr->seed);
        clear = (passed.x + passed.y + passed.z) / 3;
        if (!(clear > 0)) return 0;
    }
    double aperture = scene->shadow_aperture;
    Cone shadow = {point, ray.direction, cone_diameter(cone, r->t) * aperture, cone->spread * aperture + light_spread(light, &ray)};
    SkinPoint place = r->point;
    bool seam = false;
    SkinSide side = skin_locate(&scene->skins[r->skin], point, r->tolerance, &place, &seam);
    if (side == SKIN_LOST || side == SKIN_BORDER) return clear * skin_light_through(&tr->light, &shadow, ray.distance, -1, to_eye);
    place.w = double_clamp(place.w, 0, 1);
    float visible = skin_light_on_matter(&tr->light, &shadow, ray.distance, r->skin, &place, r->tolerance, to_eye);
    return visible > 0 ? clear * visible * skin_light_through(&tr->light, &shadow, ray.distance, (int)r->skin, to_eye) : 0;
}

/* The visibility at t, known at 0 and 1. Light falls exponentially with the matter that it has passed, and in voxels that are as large as the layer is high to
 * a third and less from one record to the next: before the first place that is asked there is far more of it. Where anything is quite dark there is an
 * edge between the two, of which nothing is known. */
static float visibility_beside(float a, float b, float t) {
    t = float_clamp(t, -1, 2);
    if (!(float_min(a, b) > DARKEST_OF_FALL)) return float_max(0, a + (b - a) * float_clamp(t, 0, 1));
    return float_min(a * powf(b / a, t), float_max(1, float_max(a, b)));
}

/* Light of one source over the records with shadows. Visibility is found at a few records, at equal shares of the light
 * that is to be tested, and interpolated over that share in between: neighbours along a cone have nearly the same shadow. */
static Vec3f add_shadowed(Tracer *tr, const Cone *cone, size_t count, size_t light_index) {
    const Light *light = &tr->compiled->scene->lights[light_index];
    size_t stride = tr->compiled->scene->light_count + 1;
    const Vec3f *direct = tr->direct + light_index;
    float total = 0;
    for (size_t i = 0; i < count; i++) total += luminance(direct[i * stride]);
    Vec3f sum = {0, 0, 0};
    if (total <= 0) return sum;
    bool worth = total > SHADOW_WORTH && !light_comes_everywhere(light);
    int points = worth ? int_clamp(1 + (int)(total * SHADOWS_PER_LIGHT), 1, MOST_SHADOW_POINTS) : 0;
    if (worth && count == 1) points = 1;
    float seen[MOST_SHADOW_POINTS + 1], at[MOST_SHADOW_POINTS + 1];
    float passed = 0;
    int next = 0;
    for (size_t i = 0; i < count && next < points; i++) {
        const ShadeRecord *r = &tr->records[i];
        float light_here = luminance(direct[i * stride]);
        float target = total * ((float)next + 0.5f) / (float)points;
        if (passed + light_here >= target) {
            at[next] = passed + light_here / 2;
            seen[next] = record_visibility(tr, light, cone, r);
            next++;
            while (next < points && passed + light_here >= total * ((float)next + 0.5f) / (float)points) { /* one record, two targets */
                at[next] = at[next - 1];
                seen[next] = seen[next - 1];
                next++;
            }
        }
        passed += light_here;
    }
    points = next;
    passed = 0;
    int k = 0;
    for (size_t i = 0; i < count; i++) {
        float light_here = luminance(direct[i * stride]), middle = passed + light_here / 2;
        float visible = 1;
        if (points) {
            while (k + 2 < points && at[k + 1] <= middle) k++;
            visible = k + 1 < points && at[k + 1] > at[k] ? visibility_beside(seen[k], seen[k + 1], (middle - at[k]) / (at[k + 1] - at[k])) : seen[k];
        }
        sum = vec3f_madd(sum, direct[i * stride], visible);
        passed += light_here;
    }
    return sum;
}

/* What explicit objects leave of the sky over the matter that the records tell of: as at that of the most light. The skins know themselves. */
static Vec3f sky_over(Tracer *tr, const Cone *cone, size_t count, Vec3f ambient) {
    const ShadeRecord *most = tr->records;
    SurfaceTracer surfaces = {.compiled = tr->compiled, .counters = &tr->counters, .part = tr->part};
    if (!tr->compiled->scene->settings.sky_light || !(luminance(ambient) > 0)) return vec3f(1, 1, 1);
    for (size_t i = 1; i < count; i++)
        if (luminance(tr->records[i].ambient) > luminance(most->ambient)) most = &tr->records[i];
    TexturePlace place = skin_texture_place(&tr->compiled->skins[most->skin].cells[most->point.cell], &most->point);
    Vec3 up = vec3_normalize(place.grad_layer);
    if (vec3_length_squared(up) == 0) return vec3f(1, 1, 1);
    Leg leg;
    surface_leg(cone, &leg);
    const SkyPlace over = {cone_point(cone, most->t), up, up, most->tolerance, &leg, true};
    return surface_sky(&surfaces, &over, float_max(ambient.x, float_max(ambient.y, ambient.z)), random_mix(tr->seed + 13));
}

Vec3f trace_skins(Tracer *tr, const Cone *cone, const ConeStart *start, double t_max, float *transmittance) {
    const Scene *scene = tr->compiled->scene;
    tr->counters.camera_rays++;
    if (tr->matter) matter_sum_begin(tr->matter);
    size_t count = gather(tr, cone, start, t_max, transmittance);
    Vec3f color = {0, 0, 0}, ambient = {0, 0, 0};
    double mean_t = 0;
    for (size_t i = 0; i < count; i++) {
        color = vec3f_add(color, tr->records[i].glow);
        ambient = vec3f_add(ambient, tr->records[i].ambient);
        mean_t += (double)tr->records[i].weight * tr->records[i].t;
    }
    color = vec3f_add(color, vec3f_mul(ambient, sky_over(tr, cone, count, ambient)));
    for (size_t l = 0; l < scene->light_count; l++) color = vec3f_add(color, add_shadowed(tr, cone, count, l));
    if (count && *transmittance <= tr->compiled->opaque_below) {
        color = vec3f_scale(color, 1 / (1 - *transmittance));
        *transmittance = 0;
    }
    float covered = 1 - *transmittance;
    if (count && covered > 0) {
        SurfaceTracer surfaces = tracer_of_surfaces(tr);
        Air air = air_from_eye(&surfaces, cone, mean_t / (double)covered);
        color = air_over(&air, color, covered);
    }
    return color;
}

/* ---- explicit surfaces ---- */

static Vec3f matter_before(void *tracer, const Cone *cone, double t_max, float *transmittance) {
    const ConeStart everything = {.count = 0};
    return trace_skins(tracer, cone, &everything, t_max, transmittance);
}

static float passing_matter(void *tracer, const Cone *cone, double t_max, Vec3 to_eye) {
    return skin_light_through(&((Tracer *)tracer)->light, cone, t_max, -1, to_eye);
}

SurfaceTracer tracer_of_surfaces(Tracer *tr) {
    SurfaceTracer surfaces = {.compiled = tr->compiled, .counters = &tr->counters, .seed = tr->seed, .draw = &tr->draw, .part = tr->part, .skins = tr};
    if (tr->compiled->skin_count) surfaces.matter = matter_before, surfaces.passing = passing_matter;
    return surfaces;
}

/* Light hangs on the normal in no straight way: the mean of what bumps send is not what their mean normal sends. That is wrong by more than sharper bumps are noisy,
 * where a pixel may have as many lines of sight as it needs. */
static const double SHARP_BUMPS = 0.1;

Radiance trace_cone(Tracer *tr, const Cone *cone, const SurfaceHit *hit, float *reaching) {
    const Scene *scene = tr->compiled->scene;
    float transmittance = 1;
    Radiance out = {{0, 0, 0}, 0};
    if (tr->compiled->skin_count || tr->matter) {
        out.color = matter_before(tr, cone, hit ? hit->t : VTS_INFINITY, &transmittance);
        out.alpha = 1 - transmittance;
    } else {
        tr->counters.camera_rays++;
    }
    *reaching = transmittance;
    if (transmittance <= 0) return out;
    SurfaceTracer surfaces = tracer_of_surfaces(tr);
    surfaces.bumps = SHARP_BUMPS;
    Air air = air_from_eye(&surfaces, cone, hit ? hit->t : VTS_INFINITY);
    Vec3f behind;
    if (hit) surfaces.tint = tr->tint;
    out.alpha += transmittance * air.cover;
    if (hit) {
        Leg leg;
        surface_eye_leg(tr->compiled, cone, &leg);
        leg.weight = transmittance;
        behind = surface_radiance(&surfaces, &leg, hit);
        if (tr->tint) tr->tint->lit = vec3f_scale(vec3f_mul(tr->tint->lit, air.keep), transmittance);
        out.alpha = 1;
    } else {
        behind = sky_radiance(scene, cone->direction, cone->spread);
    }
    out.color = vec3f_madd(out.color, air_over(&air, behind, 1), transmittance);
    return out;
}
