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

Color sky_color(const Pigment *const *layers, size_t count, Vec3 direction, double footprint) {
    Color color = {0, 0, 0, 0, 1};
    for (size_t k = 0; k < count; k++) {
        Color layer = pigment_color(layers[k], direction, direction, footprint);
        color = k ? color_over(layer, color) : layer;
    }
    return color;
}
