#include "image/image.h"

#include <stdlib.h>
#include <string.h>

static const char *const DEFAULT_NAMES[5][4] = {
    {0}, {"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};

static size_t pixel_bytes(const Image *image) {
    return sizeof(float) * (size_t)image->width * (size_t)image->height * (size_t)image->channels;
}

static const char *size_error(int width, int height, int channels) {
    if (width < 1 || height < 1 || channels < 1) return "a picture needs at least one pixel and one channel";
    if (width > IMAGE_LARGEST_SIDE || height > IMAGE_LARGEST_SIDE || channels > IMAGE_LARGEST_CHANNELS)
        return "the picture is too large";
    if ((int64_t)width * height > IMAGE_LARGEST_SAMPLES / channels) return "the picture is too large";
    return NULL;
}

/* Channels past four without names are called c0, c1 … */
static void set_names(Image *image, const char *const *names) {
    const char **copy = arena_new_array(&image->texts, const char *, (size_t)image->channels);
    for (int c = 0; c < image->channels; c++)
        if (names)
            copy[c] = arena_strdup(&image->texts, names[c]);
        else
            copy[c] = image->channels <= 4 ? DEFAULT_NAMES[image->channels][c]
                                           : arena_printf(&image->texts, "c%d", c);
    image->names = copy;
}

bool image_init(Image *image, int width, int height, int channels, const char *const *names,
                MemoryBudget *budget, StrBuf *error) {
    *image = (Image){.stored_as = IMAGE_SAMPLE_FLOAT};
    const char *wrong = size_error(width, height, channels);
    if (!wrong) {
        *image =
            (Image){.width = width, .height = height, .channels = channels, .stored_as = IMAGE_SAMPLE_FLOAT};
        if (!memory_budget_take(budget, pixel_bytes(image)))
            wrong = "the picture does not fit into the memory limit";
    }
    if (!wrong && !(image->pixels = calloc(1, pixel_bytes(image)))) {
        memory_budget_give_back(budget, pixel_bytes(image));
        wrong = "not enough memory for the picture";
    }
    if (wrong) {
        *image = (Image){0};
        if (error) strbuf_addf(error, "%s (%d x %d pixels of %d channels)", wrong, width, height, channels);
        return false;
    }
    image->budget = budget;
    arena_init(&image->texts, NULL, 1024);
    set_names(image, names);
    return true;
}

void image_free(Image *image) {
    if (image->pixels) {
        free(image->pixels);
        memory_budget_give_back(image->budget, pixel_bytes(image));
        arena_destroy(&image->texts);
    }
    *image = (Image){0};
}

int image_channel(const Image *image, const char *name) {
    for (int c = 0; c < image->channels; c++)
        if (strcmp(image->names[c], name) == 0) return c;
    return -1;
}

static ImageAttribute *find_attribute(const Image *image, const char *name) {
    for (size_t i = 0; i < image->attribute_count; i++)
        if (strcmp(image->attributes[i].name, name) == 0) return &image->attributes[i];
    return NULL;
}

static void set_attribute(Image *image, const char *name, const char *text, double number) {
    ImageAttribute *attribute = find_attribute(image, name);
    if (!attribute) {
        if (image->attribute_count == image->attribute_capacity)
            arena_list_grow_(&image->texts, (void **)&image->attributes, &image->attribute_capacity,
                             image->attribute_count, sizeof(ImageAttribute));
        attribute = &image->attributes[image->attribute_count++];
        attribute->name = arena_strdup(&image->texts, name);
    }
    attribute->text = text ? arena_strdup(&image->texts, text) : NULL;
    attribute->number = number;
}

void image_set_text(Image *image, const char *name, const char *text) { set_attribute(image, name, text, 0); }
void image_set_number(Image *image, const char *name, double number) {
    set_attribute(image, name, NULL, number);
}
const ImageAttribute *image_attribute(const Image *image, const char *name) {
    return find_attribute(image, name);
}
