/* One builder for each of the rarer solids. */
#include "eval/build_rare.h"
#include "eval/eval_files.h"
#include "tape/tape_interval.h"

#include <string.h>

/* Blocks that hold nothing but a declared object are copies. */
#define BEGIN(...)                                                                                           \
    if (object_is_copy(block)) return build_object(context, block, out);                                     \
    Reader reader = reader_begin(context, block);                                                            \
    RareDraft draft = {__VA_ARGS__};                                                                         \
    if (!rare_begin(&draft, &reader)) return false

/* ---- algebraic ---- */

bool build_quadric(BuildContext *context, const EvalBlock *block, Value *out) {
    BEGIN(.solid.kind = SOLID_QUADRIC);
    Solid *s = &draft.solid;
    return rare_vector(&draft, "the squares' factors", &s->as.quadric.squares) &&
           rare_vector(&draft, "the products' factors", &s->as.quadric.mixed) &&
           rare_vector(&draft, "the linear factors", &s->as.quadric.linear) &&
           rare_float(&draft, "the constant", &s->as.quadric.constant) && rare_end(&draft, out);
}

/* The place of x^i y^j z^k among the coefficients of this order, which fall lexicographically. */
static size_t polynomial_term(int order, const double *power) {
    size_t at = 0;
    for (int i = order; i >= 0; i--)
        for (int j = order - i; j >= 0; j--)
            for (int k = order - i - j; k >= 0; k--, at++)
                if (i == power[0] && j == power[1] && k == power[2]) return at;
    return at;
}

/* polynomial { order, xyz(i, j, k): coefficient, … } */
static bool read_terms(RareDraft *draft, int order, double *coefficients, size_t count) {
    while (rare_numbers_left(draft)) {
        double term[4];
        for (int i = 0; i < 4; i++)
            if (!rare_float(draft, "xyz(i, j, k): coefficient", &term[i])) return false;
        size_t at = polynomial_term(order, term);
        if (at == count) {
            reader_error(draft->reader, draft->reader->block->word_span,
                         "'%s' of order %d has no term xyz(%g, %g, %g)", draft->reader->block->word->text,
                         order, term[0], term[1], term[2]);
            return false;
        }
        coefficients[at] = term[3];
    }
    return true;
}

/* poly, cubic, quartic: one vector, or as many numbers. */
bool build_polynomial(BuildContext *context, const EvalBlock *block, Value *out) {
    BEGIN(.solid.kind = SOLID_POLYNOMIAL);
    const char *word = block->word->text;
    size_t order = word[0] == 'c' ? 3 : 4, count = 0;
    if (word[0] == 'p' && !rare_count(&draft, "the order", 2, &order)) return false;
    if (order > 35) {
        reader_error(&reader, block->word_span, "the order of '%s' is at most 35", word);
        return false;
    }
    size_t wanted = solid_polynomial_terms((int)order);
    double *c = arena_new_array(context->arena, double, wanted);
    if (strcmp(word, "polynomial") == 0) {
        if (!read_terms(&draft, (int)order, c, wanted)) return false;
        count = wanted;
    }
    while (rare_numbers_left(&draft) && count < wanted) {
        const Value *v = &draft.row.items[draft.next].value;
        size_t size = v->kind == VALUE_VECTOR ? v->size : 1;
        for (size_t i = 0; i < size && count < wanted; i++)
            c[count++] = v->kind == VALUE_VECTOR ? v->as.components[i] : v->as.number;
        draft.next++;
    }
    if (count < wanted) {
        reader_error(&reader, block->word_span, "'%s' of order %zu has %zu coefficients, found %zu", word,
                     order, wanted, count);
        return false;
    }
    draft.solid.as.polynomial.order = (int)order;
    draft.solid.as.polynomial.coefficients = c;
    draft.solid.as.polynomial.count = wanted;
    return rare_end(&draft, out);
}

bool build_superellipsoid(BuildContext *context, const EvalBlock *block, Value *out) {
    BEGIN(.solid.kind = SOLID_SUPERELLIPSOID);
    Point2 e;
    if (!rare_point2(&draft, "the exponents <e, n>", &e)) return false;
    if (!(e.x >= 0 && e.y >= 0)) {
        reader_error(&reader, block->word_span, "the exponents of 'superellipsoid' must not be negative");
        return false;
    }
    static const double least = 1e-3; /* as sharp as can be told from 0 */
    draft.solid.as.superellipsoid.east_west = double_max(e.x, least);
    draft.solid.as.superellipsoid.north_south = double_max(e.y, least);
    return rare_end(&draft, out);
}

bool build_ovus(BuildContext *context, const EvalBlock *block, Value *out) {
    BEGIN(.solid.kind = SOLID_OVUS);
    double *bottom = &draft.solid.as.ovus.bottom, *top = &draft.solid.as.ovus.top;
    if (!rare_float(&draft, "the bottom radius", bottom) || !rare_float(&draft, "the top radius", top))
        return false;
    if (!(*bottom >= 0 && *top >= 0)) {
        reader_error(&reader, block->word_span, "the radii of 'ovus' must not be negative");
        return false;
    }
    return rare_end(&draft, out);
}

/* ---- points and curves ---- */

static bool read_points(RareDraft *draft, size_t least, const Point2 **points, size_t *count) {
    if (!rare_count(draft, "the number of points", least, count)) return false;
    Point2 *list = arena_new_array(draft->reader->context->arena, Point2, *count);
    for (size_t i = 0; i < *count; i++)
        if (!rare_point2(draft, "a point", &list[i])) return false;
    *points = list;
    return true;
}

static bool bezier_fits(RareDraft *draft, size_t count) {
    if (draft->curve != CURVE_BEZIER || count % 4 == 0) return true;
    reader_error(draft->reader, draft->reader->block->word_span,
                 "a bezier_spline has four points for each piece, found %zu", count);
    return false;
}

/* Rings end with the point that they begin with; the next point begins another. */
static bool polygon_closes(const Vec3 *points, size_t count) {
    size_t begin = 0;
    for (size_t i = 1; i < count; i++)
        if (i > begin && vec3_length_squared(vec3_sub(points[i], points[begin])) == 0) begin = i + 1;
    return begin >= count;
}

bool build_polygon(BuildContext *context, const EvalBlock *block, Value *out) {
    BEGIN(.solid.kind = SOLID_POLYGON);
    size_t count;
    if (!rare_count(&draft, "the number of points", 3, &count)) return false;
    Vec3 *points = arena_new_array(context->arena, Vec3, count);
    for (size_t i = 0; i < count; i++)
        if (!rare_vector(&draft, "a point", &points[i])) return false;
    if (!polygon_closes(points, count))
        diag_warning(context->diags, reader_after(&reader, draft.row.items[draft.next - 1].span),
                     "this polygon does not end where it begins: it is closed");
    draft.solid.as.polygon.points = points;
    draft.solid.as.polygon.count = count;
    return rare_end(&draft, out);
}

static size_t least_points(CurveKind curve) {
    static const size_t least[] = {[CURVE_LINEAR] = 2,
                                   [CURVE_QUADRATIC] = 3,
                                   [CURVE_CUBIC] = 4,
                                   [CURVE_BEZIER] = 4,
                                   [CURVE_B_SPLINE] = 4};
    return least[curve];
}

bool build_lathe(BuildContext *context, const EvalBlock *block, Value *out) {
    BEGIN(.solid.kind = SOLID_LATHE);
    draft.solid.as.turned.curve = draft.curve;
    draft.solid.as.turned.open = draft.open;
    return read_points(&draft, least_points(draft.curve), &draft.solid.as.turned.points,
                       &draft.solid.as.turned.count) &&
           bezier_fits(&draft, draft.solid.as.turned.count) && rare_end(&draft, out);
}

bool build_sor(BuildContext *context, const EvalBlock *block, Value *out) {
    BEGIN(.solid.kind = SOLID_SOR);
    draft.solid.as.turned.curve = CURVE_CUBIC;
    draft.solid.as.turned.open = draft.open;
    if (!read_points(&draft, 4, &draft.solid.as.turned.points, &draft.solid.as.turned.count)) return false;
    const Point2 *p = draft.solid.as.turned.points;
    for (size_t i = 1; i + 2 < draft.solid.as.turned.count; i++)
        if (!(p[i + 1].y > p[i].y)) {
            reader_error(&reader, block->word_span,
                         "the heights of the points of 'sor' must grow from each to the next");
            return false;
        }
    return rare_end(&draft, out);
}

bool build_prism(BuildContext *context, const EvalBlock *block, Value *out) {
    BEGIN(.solid.kind = SOLID_PRISM);
    Solid *s = &draft.solid;
    double a, b;
    if (!rare_float(&draft, "the first height", &a) || !rare_float(&draft, "the second height", &b))
        return false;
    s->as.prism.curve = draft.curve;
    s->as.prism.conic = draft.conic;
    s->as.prism.open = draft.open;
    s->as.prism.low = double_min(a, b);
    s->as.prism.high = double_max(a, b);
    return read_points(&draft, least_points(draft.curve) + (draft.curve == CURVE_LINEAR), &s->as.prism.points,
                       &s->as.prism.count) &&
           bezier_fits(&draft, s->as.prism.count) && rare_end(&draft, out);
}

bool build_sweep(BuildContext *context, const EvalBlock *block, Value *out) {
    BEGIN(.solid.kind = SOLID_SWEEP);
    size_t count;
    if (!rare_count(&draft, "the number of spheres", least_points(draft.curve), &count)) return false;
    SweepSphere *spheres = arena_new_array(context->arena, SweepSphere, count);
    for (size_t i = 0; i < count; i++) {
        if (!rare_vector(&draft, "a centre", &spheres[i].center) ||
            !rare_float(&draft, "a radius", &spheres[i].radius))
            return false;
    }
    draft.solid.as.sweep.curve = draft.curve;
    draft.solid.as.sweep.spheres = spheres;
    draft.solid.as.sweep.count = count;
    return rare_end(&draft, out);
}

bool build_patch(BuildContext *context, const EvalBlock *block, Value *out) {
    BEGIN(.solid.kind = SOLID_PATCH);
    for (int i = 0; i < 16; i++)
        if (!rare_vector(&draft, "a control point", &draft.solid.as.patch.points[i])) return false;
    return rare_end(&draft, out);
}

/* ---- fields ---- */

bool build_blob(BuildContext *context, const EvalBlock *block, Value *out) {
    BEGIN(.solid.kind = SOLID_BLOB, .takes_parts = true, .threshold = 1);
    if (draft.parts.count == 0) {
        reader_error(&reader, reader_close(&reader), "'blob' without parts");
        return false;
    }
    draft.solid.as.blob.threshold = draft.threshold;
    draft.solid.as.blob.parts = draft.parts.items;
    draft.solid.as.blob.count = draft.parts.count;
    for (size_t i = 0; i < draft.parts.count; i++) draft.solid.as.blob.textured |= draft.parts.items[i].texture != NULL;
    return rare_end(&draft, out);
}

/* POV-Ray's default container. */
static const Object *unit_container(const BuildContext *context) {
    Object box = {.kind = OBJECT_BOX};
    box.as.box.corner1 = vec3_splat(-1);
    box.as.box.corner2 = vec3_splat(1);
    return object_keep(context->arena, &box, NULL);
}

static bool next_function(RareDraft *draft, int parameters, const Tape **out) {
    const EvalBlock *block = draft->reader->block;
    if (!rare_numbers_left(draft)) {
        reader_error(draft->reader, block->word_span, "'%s' needs a function", block->word->text);
        return false;
    }
    const Argument *argument = &draft->row.items[draft->next++];
    /* Without parameters of its own a function has three. */
    bool default_ones =
        argument->value.kind == VALUE_FUNCTION && argument->value.as.function->parameter_count == 3;
    return argument_function(draft->reader, argument, block->word->text,
                             default_ones ? 3 : parameters, 1, out);
}

bool build_isosurface(BuildContext *context, const EvalBlock *block, Value *out) {
    BEGIN(.solid.kind = SOLID_ISOSURFACE, .accuracy = 0.001, .max_gradient = 1.1);
    Solid *s = &draft.solid;
    if (!next_function(&draft, 3, &s->as.isosurface.function)) return false;
    s->as.isosurface.container = draft.container ? draft.container : unit_container(context);
    s->as.isosurface.threshold = draft.threshold;
    s->as.isosurface.accuracy = draft.accuracy;
    s->as.isosurface.max_gradient = draft.max_gradient;
    s->as.isosurface.open = draft.open;
    s->as.isosurface.method = draft.method;
    s->as.isosurface.full_detail = draft.full_detail;
    if (!tape_is_bounded(s->as.isosurface.function))
        diag_warning(context->diags, block->word_span,
                     "a part of this isosurface's function has no bounds: rays march by 'max_gradient', and may miss parts of it");
    return rare_end(&draft, out);
}

bool build_parametric(BuildContext *context, const EvalBlock *block, Value *out) {
    BEGIN(.solid.kind = SOLID_PARAMETRIC, .accuracy = 0.001);
    Solid *s = &draft.solid;
    Point2 low, high;
    for (int i = 0; i < 3; i++)
        if (!next_function(&draft, 2, &s->as.parametric.functions[i])) return false;
    if (!rare_point2(&draft, "the first corner of <u, v>", &low) ||
        !rare_point2(&draft, "the second corner of <u, v>", &high))
        return false;
    s->as.parametric.u0 = low.x, s->as.parametric.v0 = low.y;
    s->as.parametric.u1 = high.x, s->as.parametric.v1 = high.y;
    s->as.parametric.accuracy = draft.accuracy;
    s->as.parametric.container = draft.container;
    return rare_end(&draft, out);
}

/* What POV-Ray can draw: the quaternions' other functions have no known roots, and a slice must not contain the fourth axis. */
static bool check_julia(RareDraft *draft) {
    Span span = draft->reader->block->word_span;
    bool power = draft->function == JULIA_SQR || draft->function == JULIA_CUBE;
    if (!draft->hypercomplex && !power)
        reader_error(draft->reader, span, "with quaternions a julia_fractal has the functions sqr and cube only");
    else if (draft->solid.as.julia.slice[3] == 0)
        reader_error(draft->reader, span, "the fourth component of a julia_fractal's slice cannot be 0");
    return !draft->reader->failed;
}

bool build_julia(BuildContext *context, const EvalBlock *block, Value *out) {
    BEGIN(.solid.kind = SOLID_JULIA, .iterations = 20);
    Solid *s = &draft.solid;
    s->as.julia.slice[3] = 1;
    if (!rare_vector4(&draft, "the parameter <a, b, c, d>", s->as.julia.c)) return false;
    if (draft.slice_at) {
        draft.next = draft.slice_at - 1;
        if (!rare_vector4(&draft, "the normal of the slice", s->as.julia.slice) ||
            !rare_float(&draft, "the distance of the slice", &s->as.julia.distance))
            return false;
    }
    if (!check_julia(&draft)) return false;
    s->as.julia.hypercomplex = draft.hypercomplex;
    s->as.julia.function = draft.function;
    s->as.julia.iterations = double_to_int(draft.iterations, 0, 10000);
    return rare_end(&draft, out);
}

/* ---- text ---- */

static const char *find_file(const BuildContext *context, const char *name, Span span) {
    Diagnostic *refused = NULL;
    const char *path = path_find(context->eval, name, span, &refused, NULL);
    return path ? arena_strdup(context->arena, path) : NULL;
}

/* Where includes are looked for, and then where Debian keeps POV-Ray's fonts and others. */
static const char *find_named_font(const BuildContext *context, const char *name, Span span) {
    static const char *const folders[] = {"povray", "dejavu", "liberation", "liberation2", "freefont"};
    const char *path = find_file(context, name, span);
    for (size_t i = 0; !path && !strchr(name, '/') && i < VTS_ARRAY_COUNT(folders); i++)
        path = find_file(
            context, arena_printf(context->arena, "/usr/share/fonts/truetype/%s/%s", folders[i], name), span);
    return path;
}

/* As POV-Ray does, "crystal" finds crystal.ttf. */
static const char *find_font(const BuildContext *context, const char *name, Span span) {
    const char *path = find_named_font(context, name, span), *base = strrchr(name, '/');
    if (path || strchr(base ? base : name, '.')) return path;
    return find_named_font(context, arena_printf(context->arena, "%s.ttf", name), span);
}

/* `internal N` are POV-Ray's own fonts: Times, Helvetica and Courier lookalikes, and its logo. */
static const char *font_name(RareDraft *draft) {
    static const char *const internal[] = {"timrom.ttf", "timrom.ttf", "cyrvetic.ttf", "crystal.ttf",
                                           "povlogo.ttf"};
    const Value *v = &draft->row.items[draft->next++].value;
    if (v->kind == VALUE_STRING) return v->as.string.text;
    return v->kind == VALUE_FLOAT ? internal[double_to_int(v->as.number, 0, 4)] : internal[0];
}

bool build_text(BuildContext *context, const EvalBlock *block, Value *out) {
    BEGIN(.solid.kind = SOLID_TEXT, .turned = vec3_splat(SOLID_TEXT_TURN));
    Solid *s = &draft.solid;
    if (draft.row.count < 2 || draft.row.items[1].value.kind != VALUE_STRING) {
        reader_error(&reader, block->word_span, "'text' takes ttf \"FONT\" \"TEXT\" thickness, offset");
        return false;
    }
    const char *font = font_name(&draft);
    Span span = draft.row.items[0].span;
    s->as.text.text = arena_strdup(context->arena, draft.row.items[draft.next++].value.as.string.text);
    s->as.text.font_name = arena_strdup(context->arena, font);
    s->as.text.font_path = find_font(context, font, span);
    if (!s->as.text.font_path)
        diag_warning(context->diags, span, "the font '%s' is not found: another one takes its place", font);
    return rare_float(&draft, "the thickness", &s->as.text.thickness) &&
           rare_vector(&draft, "the offset", &s->as.text.offset) && rare_end(&draft, out);
}

/* ---- height_field ---- */

enum { LARGEST_FIELD = 1 << 14 };

/* Point (i, j) has x = i/(columns - 1), y = 1 - j/(rows - 1), as the pixel it would be in a picture. */
static bool sample_heights(RareDraft *draft, const UserFunction *function) {
    int columns = function->columns, rows = function->rows;
    if (columns < 2 || rows < 2 || columns > LARGEST_FIELD || rows > LARGEST_FIELD) {
        reader_error(draft->reader, draft->reader->block->word_span,
                     "the function of a 'height_field' needs a resolution from 2, 2 to 16384, 16384");
        return false;
    }
    if (!reader_mesh_fits(draft->reader, draft->reader->block->word_span, (double)columns * rows)) return false;
    double *heights = arena_new_array(draft->reader->context->arena, double, (size_t)columns *(size_t)rows);
    double *out = heights;
    bool colored = tape_output_count(function->tape) >= 3; /* a pigment: its grey */
    for (int j = 0; j < rows; j++)
        for (int i = 0; i < columns; i++, out++) {
            double place[3] = {(double)i / (columns - 1), 1 - (double)j / (rows - 1), 0},
                   value[TAPE_CALL_MAX] = {0};
            tape_eval_once(function->tape, place, value);
            double height = value[0];
            if (colored) height = 0.297 * value[0] + 0.589 * value[1] + 0.114 * value[2];
            *out = height > 0 ? double_min(height, 1) : 0;
        }
    draft->solid.as.field.columns = columns;
    draft->solid.as.field.rows = rows;
    draft->solid.as.field.heights = heights;
    return true;
}

bool build_height_field(BuildContext *context, const EvalBlock *block, Value *out) {
    BEGIN(.solid.kind = SOLID_HEIGHT_FIELD);
    draft.solid.as.field.smooth = draft.smooth;
    draft.solid.as.field.water_level = draft.water_level;
    const Argument *first = rare_numbers_left(&draft) ? &draft.row.items[draft.next] : NULL;
    if (first && first->value.kind == VALUE_STRING) {
        draft.next++;
        draft.picture = first->value.as.string.text;
        draft.picture_span = first->span;
    }
    draft.solid.as.field.potential = draft.potential;
    if (draft.picture) {
        draft.solid.as.field.path = find_file(context, draft.picture, draft.picture_span);
        if (!draft.solid.as.field.path) {
            reader_error(&reader, draft.picture_span, "the picture '%s' is not found", draft.picture);
            return false;
        }
        return rare_end(&draft, out);
    }
    if (!first || first->value.kind != VALUE_FUNCTION) {
        reader_error(&reader, block->word_span, "'height_field' needs a picture or a function");
        return false;
    }
    draft.next++;
    return sample_heights(&draft, first->value.as.function) && rare_end(&draft, out);
}
