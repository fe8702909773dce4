/* What a texture may do with light, and what it asks of the surface, told from its text. */
#include "image/picture.h"
#include "pattern/pattern.h"

/* Maps of maps of maps may be shared: no more than so many are looked at. */
enum { MOST_LOOKED_AT = 10000 };

static bool color_is_opaque(Color c) { return c.filter == 0 && c.transmit == 0; }

static bool pigment_is_opaque(const Pigment *pigment, int *budget) {
    if (--*budget < 0) return false;
    if (pigment->kind == PATTERN_SOLID) return color_is_opaque(pigment->color);
    if (pigment->kind == PATTERN_IMAGE_MAP) {
        const ImageMap *image = pigment->image;
        return image && !image->once && image->filter_all == 0 && image->transmit_all == 0 && !image->palette_count &&
               !(image->picture && image->picture->has_alpha);
    }
    for (size_t i = 0; i < pigment->entry_count; i++) {
        const ColorMapEntry *entry = &pigment->entries[i];
        if (entry->pigment ? !pigment_is_opaque(entry->pigment, budget) : !color_is_opaque(entry->color)) return false;
    }
    return true; /* the patterns' own maps are */
}

static bool follows_slope(const Pigment *pigment, int *budget) {
    if (--*budget < 0 || pigment->kind == PATTERN_SLOPE) return true;
    if (pigment->source && follows_slope(pigment->source, budget)) return true;
    for (size_t i = 0; i < pigment->entry_count; i++)
        if (pigment->entries[i].pigment && follows_slope(pigment->entries[i].pigment, budget)) return true;
    return false;
}

bool pigment_follows_slope(const Pigment *pigment) {
    int budget = MOST_LOOKED_AT;
    return follows_slope(pigment, &budget);
}

static bool is_opaque(const Texture *texture, int *budget) {
    for (; texture; texture = texture->under) {
        bool opaque = true;
        if (--*budget < 0) return false;
        if (!texture->map) opaque = pigment_is_opaque(texture->pigment, budget);
        else
            for (size_t i = 0; i < texture->map->count && opaque; i++) opaque = is_opaque(texture->map->textures[i], budget);
        if (opaque) return true; /* nothing passes this layer */
    }
    return false;
}

bool texture_is_opaque(const Texture *texture) {
    int budget = MOST_LOOKED_AT;
    return is_opaque(texture, &budget);
}

static bool mirrors(const Texture *texture, int *budget) {
    for (; texture; texture = texture->under) {
        const Color *low = &texture->finish->reflection_min, *high = &texture->finish->reflection_max;
        if (--*budget < 0) return true;
        if (low->red != 0 || low->green != 0 || low->blue != 0 || high->red != 0 || high->green != 0 || high->blue != 0) return true;
        for (size_t i = 0; texture->map && i < texture->map->count; i++)
            if (mirrors(texture->map->textures[i], budget)) return true;
    }
    return false;
}

bool texture_is_even(const Texture *texture) {
    for (; texture; texture = texture->under)
        if (texture->map || texture->normal || texture->pigment->kind != PATTERN_SOLID) return false;
    return true;
}

bool texture_mirrors(const Texture *texture) {
    int budget = MOST_LOOKED_AT;
    return mirrors(texture, &budget);
}
