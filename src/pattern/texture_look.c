#include "pattern/pattern.h"
#include "pattern/pigment.h"

static double mean3(double a, double b, double c) { return (a + b + c) / 3; }

Color color_over(Color top, Color below) {
    double opaque = 1 - top.filter - top.transmit, below_opaque = 1 - below.filter - below.transmit;
    if (top.filter == 0 && top.transmit == 0) return top;
    /* What passes the top layer, by channel; what passes both, as neutral transmission. */
    double red = top.transmit + top.filter * top.red, green = top.transmit + top.filter * top.green,
           blue = top.transmit + top.filter * top.blue;
    double through = mean3(red * (below.transmit + below.filter * below.red),
                           green * (below.transmit + below.filter * below.green),
                           blue * (below.transmit + below.filter * below.blue));
    double scale = through < 1 ? 1 / (1 - through) : 0;
    return (Color){(opaque * top.red + red * below_opaque * below.red) * scale,
                   (opaque * top.green + green * below_opaque * below.green) * scale,
                   (opaque * top.blue + blue * below_opaque * below.blue) * scale, 0, through};
}

/* All layers of one part. */
static Color part_color(const TexturePart *part, Vec3 normal) {
    const Texture *layers[16];
    size_t count = 0;
    for (const Texture *t = part->texture; t && count < VTS_ARRAY_COUNT(layers); t = t->under) layers[count++] = t;
    Color color = texture_layer_color(part, layers[count - 1], normal);
    for (size_t k = count - 1; k-- > 0;) color = color_over(texture_layer_color(part, layers[k], normal), color);
    return color;
}

SurfaceLook texture_look(const Texture *texture, Vec3 point, Vec3 normal, double footprint) {
    enum { MOST = 8 };
    TexturePart parts[MOST];
    SurfacePlace place = {.point = point, .normal = normal, .footprint = footprint};
    size_t count = texture_parts(texture, &place, parts, MOST), heaviest = 0;
    Color sum = {0, 0, 0, 0, 0};
    for (size_t i = 0; i < count; i++) {
        Color c = part_color(&parts[i], normal);
        double w = parts[i].weight;
        sum = (Color){sum.red + w * c.red, sum.green + w * c.green, sum.blue + w * c.blue, sum.filter + w * c.filter,
                      sum.transmit + w * c.transmit};
        if (w > parts[heaviest].weight) heaviest = i;
    }
    return (SurfaceLook){sum, parts[heaviest].texture->finish};
}

/* Layers of the sky from the top down. What passes them is by channel what each filters and transmits; with scenes of versions below 3.7 it
 * is what all filter, or what all transmit, and of colours only the background is tinted (measured). */
typedef struct SkyView {
    bool old;
    double sum[3], through[3], tint[3];
    double filter, transmit, passing;
} SkyView;

static void lay_sky(SkyView *view, const Color *layer, const Color *emission) {
    double shown = view->passing * (1 - layer->filter - layer->transmit);
    const double own[3] = {layer->red, layer->green, layer->blue}, bright[3] = {emission->red, emission->green, emission->blue};
    for (int c = 0; c < 3; c++) {
        double clear = view->old ? 1 : view->through[c];
        view->sum[c] += shown * clear * own[c] * bright[c];
        view->tint[c] *= own[c];
        view->through[c] *= layer->transmit + layer->filter * own[c];
    }
    view->filter *= layer->filter;
    view->transmit *= layer->transmit;
    if (view->old) view->passing = view->filter + view->transmit;
}

Color sky_color(const Scene *scene, Vec3 direction, double footprint) {
    SkyView view = {.old = scene->old_sky, .through = {1, 1, 1}, .tint = {1, 1, 1}, .filter = 1, .transmit = 1, .passing = 1};
    for (size_t k = scene->sky_layer_count; k-- > 0;) {
        Color layer = pigment_color(scene->sky_layers[k], direction, direction, footprint);
        lay_sky(&view, &layer, &scene->sky_emission);
    }
    const double behind[3] = {scene->background.red, scene->background.green, scene->background.blue};
    for (int c = 0; c < 3; c++)
        view.sum[c] += behind[c] * (view.old ? view.filter * view.tint[c] + view.transmit : view.through[c]);
    return (Color){view.sum[0], view.sum[1], view.sum[2], 0, 0};
}
