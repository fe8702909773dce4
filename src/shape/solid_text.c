/* text: letters as solids between z = 0 and the thickness. */
#include "shape/box_tree.h"
#include "shape/font_outline.h"
#include "shape/solid.h"
#include "shape/solid_parts.h"
#include "shape/solid_text.h"

static const uint32_t PART_CAP = UINT32_MAX;

typedef struct TextSolid {
    FontLine line;
    const Vec3 *places; /* of the glyphs' origins */
    const BoxTree *tree;
    Box3 bounds;
    double thickness;
} TextSolid;

static Box3 glyph_box(const FontGlyph *glyph, Vec3 place, double thickness) {
    if (!glyph->outline.count) return box3_empty();
    Vec3 low = {glyph->outline.min.x, glyph->outline.min.y, 0},
         high = {glyph->outline.max.x, glyph->outline.max.y, thickness};
    return (Box3){vec3_add(place, low), vec3_add(place, high)};
}

/* The offset moves each letter but the first on by its x and y. */
static const void *prepare(const Object *object, Arena *arena) {
    const Solid *s = object->as.solid;
    TextSolid *text = arena_new(arena, TextSolid);
    const char *path = s->as.text.font_path ? s->as.text.font_path : font_substitute(s->as.text.font_name);
    if (!path || !font_outline(path, s->as.text.text, arena, &text->line)) return NULL;
    Vec3 *places = arena_new_array(arena, Vec3, text->line.count);
    Box3 *boxes = arena_new_array(arena, Box3, text->line.count);
    text->thickness = s->as.text.thickness;
    text->bounds = box3_empty();
    for (size_t i = 0; i < text->line.count; i++) {
        const FontGlyph *glyph = &text->line.glyphs[i];
        places[i] =
            vec3(glyph->x + (double)i * s->as.text.offset.x, glyph->y + (double)i * s->as.text.offset.y, 0);
        boxes[i] = glyph_box(glyph, places[i], text->thickness);
        if (!box3_is_empty(boxes[i])) text->bounds = box3_union(text->bounds, boxes[i]);
    }
    text->places = places;
    text->tree = box_tree_build(boxes, text->line.count, arena);
    return text;
}

typedef struct GlyphVisit {
    const TextSolid *text;
    const Ray *ray;
    SolidSink *sink;
} GlyphVisit;

/* tag.v tells the letter. */
static void visit_glyph(void *context, uint32_t index) {
    const GlyphVisit *visit = context;
    const TextSolid *text = visit->text;
    const Outline *outline = &text->line.glyphs[index].outline;
    Vec3 o = vec3_sub(visit->ray->origin, text->places[index]), d = visit->ray->direction;
    for (uint32_t k = 0; k < 2 && d.z != 0; k++) {
        double t = ((k ? text->thickness : 0) - o.z) / d.z;
        if (t > visit->sink->t_min && t < visit->sink->t_max &&
            outline_winding(outline, (Point2){o.x + t * d.x, o.y + t * d.y}))
            solid_offer(visit->sink, t, (SolidTag){PART_CAP, k, index});
    }
    double across = d.x * d.x + d.y * d.y;
    for (uint32_t i = 0; i < outline->count && across > 0; i++) {
        double s[3];
        int count = outline_meet(&outline->items[i], d.y, -d.x, o.y * d.x - o.x * d.y, s);
        for (int k = 0; k < count; k++) {
            Point2 c = outline_at(&outline->items[i], s[k]);
            double t = ((c.x - o.x) * d.x + (c.y - o.y) * d.y) / across, z = o.z + t * d.z;
            if (z >= 0 && z <= text->thickness) solid_offer(visit->sink, t, (SolidTag){i, s[k], index});
        }
    }
}

static void cross(const void *data, const Ray *ray, SolidSink *sink) {
    const TextSolid *text = data;
    GlyphVisit visit = {text, ray, sink};
    box_tree_ray(text->tree, ray, sink->t_min, &sink->t_max, visit_glyph, &visit);
}

/* POV-Ray's walls face the inside of their letters. */
static Vec3 normal(const void *data, Vec3 p, const SolidTag *tag) {
    const TextSolid *text = data;
    (void)p;
    if (tag->part == PART_CAP) return vec3(0, 0, tag->u > 0 ? 1 : -1);
    Point2 t = outline_tangent(&text->line.glyphs[(size_t)tag->v].outline.items[tag->part], tag->u);
    double side = text->line.filled_on_right ? 1 : -1;
    return vec3_normalize(vec3(side * t.y, -side * t.x, 0));
}

Box3 solid_text_extent(const void *data) {
    const TextSolid *text = data;
    Box3 box = box3_empty();
    for (size_t i = 0; text && i < text->line.count; i++) {
        const FontGlyph *glyph = &text->line.glyphs[i];
        Vec3 low = {glyph->min.x, glyph->min.y, 0}, high = {glyph->max.x, glyph->max.y, text->thickness};
        box = box3_union(box, (Box3){vec3_add(text->places[i], low), vec3_add(text->places[i], high)});
    }
    return box;
}

bool solid_text_letter(const void *data, size_t index, PlanarOutline *out, double *thickness) {
    const TextSolid *text = data;
    if (index >= text->line.count) return false;
    *out = (PlanarOutline){&text->line.glyphs[index].outline, text->places[index], {1, 0, 0}, {0, 1, 0}};
    *thickness = text->thickness;
    return true;
}

typedef struct PointInText {
    const TextSolid *text;
    Vec3 point;
} PointInText;

static bool in_glyph(void *context, uint32_t index) {
    const PointInText *at = context;
    Vec3 p = vec3_sub(at->point, at->text->places[index]);
    return outline_winding(&at->text->line.glyphs[index].outline, (Point2){p.x, p.y}) != 0;
}

static bool inside(const void *data, Vec3 p) {
    const TextSolid *text = data;
    return box_tree_point(text->tree, p, in_glyph, &(PointInText){text, p});
}

static Box3 bounds(const void *data) { return ((const TextSolid *)data)->bounds; }

const SolidOps solid_text_ops = {
    .prepare = prepare, .cross = cross, .normal = normal, .inside = inside, .bounds = bounds};
