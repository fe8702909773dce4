#include "shape/font_outline.h"

#include "base/module.h"
#include "shape/freetype_shim.h"

#include <stdio.h>
#include <string.h>

typedef struct Pen {
    Arena *arena;
    Outline *outline;
    Point2 at, start;
    double unit;
} Pen;

static Point2 point(const Pen *pen, const FT_Vector *v) {
    return (Point2){(double)v->x * pen->unit, (double)v->y * pen->unit};
}

static int move_to(const FT_Vector *to, void *user) {
    Pen *pen = user;
    outline_add_line(pen->arena, pen->outline, pen->at, pen->start);
    pen->at = pen->start = point(pen, to);
    return 0;
}

static int line_to(const FT_Vector *to, void *user) {
    Pen *pen = user;
    Point2 p = point(pen, to);
    outline_add_line(pen->arena, pen->outline, pen->at, p);
    pen->at = p;
    return 0;
}

static int conic_to(const FT_Vector *control, const FT_Vector *to, void *user) {
    Pen *pen = user;
    Point2 a = pen->at, b = point(pen, control), c = point(pen, to);
    outline_add(pen->arena, pen->outline, (double[]){a.x, 2 * (b.x - a.x), a.x - 2 * b.x + c.x, 0},
                (double[]){a.y, 2 * (b.y - a.y), a.y - 2 * b.y + c.y, 0});
    pen->at = c;
    return 0;
}

static int cubic_to(const FT_Vector *first, const FT_Vector *second, const FT_Vector *to, void *user) {
    Pen *pen = user;
    const Point2 p[4] = {pen->at, point(pen, first), point(pen, second), point(pen, to)};
    outline_add_bezier(pen->arena, pen->outline, p);
    pen->at = p[3];
    return 0;
}

static void draw_glyph(const FreetypeShim *ft, FT_Face face, double unit, Arena *arena, Outline *out) {
    const FT_Outline_Funcs functions = {move_to, line_to, conic_to, cubic_to, 0, 0};
    Pen pen = {.arena = arena, .outline = out, .unit = unit};
    ft->Outline_Decompose(&face->glyph->outline, &functions, &pen);
    outline_add_line(arena, out, pen.at, pen.start);
}

/* The next character; what is not UTF-8 stands for itself (Latin-1). */
static uint32_t next_character(const char **text) {
    const unsigned char *p = (const unsigned char *)*text;
    int more = p[0] >= 0xF0 ? 3 : p[0] >= 0xE0 ? 2 : p[0] >= 0xC2 ? 1 : 0;
    uint32_t c = more == 3 ? p[0] & 7u : more == 2 ? p[0] & 15u : more == 1 ? p[0] & 31u : p[0];
    for (int i = 1; i <= more; i++) {
        if ((p[i] & 0xC0) != 0x80) {
            (*text)++;
            return p[0];
        }
        c = c << 6 | (p[i] & 63u);
    }
    *text += 1 + more;
    return c;
}

/* Symbol fonts keep their glyphs at 0xF000. */
static FT_UInt glyph_of(const FreetypeShim *ft, FT_Face face, uint32_t character) {
    FT_UInt glyph = ft->Get_Char_Index(face, character);
    return glyph ? glyph : ft->Get_Char_Index(face, 0xF000 + character);
}

static double kerning(const FreetypeShim *ft, FT_Face face, FT_UInt before, FT_UInt glyph) {
    FT_Vector by;
    if (!before || !glyph || ft->Get_Kerning(face, before, glyph, FT_KERNING_UNSCALED, &by)) return 0;
    return (double)by.x;
}

static void set_line(const FreetypeShim *ft, FT_Face face, const char *text, Arena *arena, FontLine *out) {
    double unit = 1.0 / (face->units_per_EM ? face->units_per_EM : 1000), x = 0;
    FontGlyph *glyphs = arena_new_array(arena, FontGlyph, strlen(text));
    FT_UInt before = 0;
    while (*text) {
        FT_UInt index = glyph_of(ft, face, next_character(&text));
        if (ft->Load_Glyph(face, index, FT_LOAD_NO_SCALE | FT_LOAD_NO_BITMAP)) continue;
        FontGlyph *glyph = &glyphs[out->count];
        const FT_Glyph_Metrics *metrics = &face->glyph->metrics;
        if (out->count == 0) x = -(double)metrics->horiBearingX * unit;
        x += kerning(ft, face, before, index) * unit;
        if (face->glyph->format == FT_GLYPH_FORMAT_OUTLINE) {
            draw_glyph(ft, face, unit, arena, &glyph->outline);
            if (glyph->outline.count)
                out->filled_on_right =
                    ft->Outline_Get_Orientation(&face->glyph->outline) == FT_ORIENTATION_TRUETYPE;
        }
        glyph->x = x;
        glyph->min = glyph->outline.min;
        glyph->max = glyph->outline.max;
        glyph->max.x -= double_min(glyph->min.x, 0);
        x += (double)metrics->horiAdvance * unit;
        before = index;
        out->count++;
    }
    out->glyphs = glyphs;
}

/* On demand: with the libraries that it brings it takes 0.4 ms to load, a third of a start, and few scenes have a text. */
static const FreetypeShim *freetype(void) {
    StrBuf why = {0};
    const FreetypeShim *ft = module_load("libvts_freetype.so", "vts_freetype_shim", FREETYPE_SHIM_VERSION, &why);
    strbuf_free(&why);
    return ft;
}

bool font_outline(const char *path, const char *text, Arena *arena, FontLine *out) {
    FT_Library library;
    FT_Face face;
    *out = (FontLine){.filled_on_right = true};
    const FreetypeShim *ft = freetype();
    if (!ft || ft->Init_FreeType(&library)) return false;
    bool ok = ft->New_Face(library, path, 0, &face) == 0;
    if (ok) {
        if (FT_IS_SCALABLE(face)) set_line(ft, face, text, arena, out);
        ft->Done_Face(face);
    }
    ft->Done_FreeType(library);
    return ok && out->count;
}

static bool exists(const char *path) {
    FILE *f = fopen(path, "rb");
    if (f) fclose(f);
    return f != NULL;
}

const char *font_substitute(const char *name) {
    static const char *const serif[] = {"/usr/share/fonts/truetype/povray/timrom.ttf",
                                        "/usr/share/fonts/truetype/liberation/LiberationSerif-Regular.ttf",
                                        "/usr/share/fonts/truetype/liberation2/LiberationSerif-Regular.ttf",
                                        "/usr/share/fonts/truetype/dejavu/DejaVuSerif.ttf",
                                        "/usr/share/fonts/truetype/freefont/FreeSerif.ttf",
                                        "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"};
    static const char *const sans[] = {"/usr/share/fonts/truetype/povray/cyrvetic.ttf",
                                       "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf",
                                       "/usr/share/fonts/truetype/liberation2/LiberationSans-Regular.ttf",
                                       "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                                       "/usr/share/fonts/truetype/freefont/FreeSans.ttf",
                                       "/usr/share/fonts/truetype/dejavu/DejaVuSerif.ttf"};
    const char *const *list = name && (strstr(name, "tim") || strstr(name, "erif")) ? serif : sans;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(serif); i++)
        if (exists(list[i])) return list[i];
    return NULL;
}
