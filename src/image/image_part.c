#include "image/image_part.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

void image_part_print(const ImagePart *p, StrBuf *out) {
    strbuf_addf(out, "%d,%d,%d,%d of %dx%d %016" PRIx64, p->x, p->y, p->x + p->width, p->y + p->height, p->whole_width, p->whole_height, p->key);
}

/* Nothing in a file is trusted: what lies outside of its whole is no part of it. */
static bool is_possible(const ImagePart *p, int x1, int y1) {
    return p->x >= 0 && p->y >= 0 && x1 > p->x && y1 > p->y && x1 <= p->whole_width && y1 <= p->whole_height &&
           p->whole_width <= IMAGE_LARGEST_SIDE && p->whole_height <= IMAGE_LARGEST_SIDE;
}

bool image_part_parse(const char *text, ImagePart *out) {
    int x1, y1, end = 0;
    *out = (ImagePart){0};
    if (sscanf(text, "%7d,%7d,%7d,%7d of %7dx%7d %16" SCNx64 "%n", &out->x, &out->y, &x1, &y1, &out->whole_width, &out->whole_height, &out->key,
               &end) != 7 ||
        text[end] != '\0' || !is_possible(out, x1, y1))
        return false;
    out->width = x1 - out->x, out->height = y1 - out->y;
    return true;
}

void image_part_set(Image *image, const ImagePart *part) {
    StrBuf text = {0};
    image_part_print(part, &text);
    image_set_text(image, IMAGE_PART_NAME, text.data);
    strbuf_free(&text);
}

/* TIFF and JPEG have it as a line of the description. */
static bool parse_description(const char *text, ImagePart *out) {
    static const char name[] = IMAGE_PART_NAME "=";
    const char *at = text;
    while (at && strncmp(at, name, sizeof name - 1) != 0) at = (at = strchr(at, '\n')) ? at + 1 : NULL;
    if (!at) return false;
    char line[128];
    at += sizeof name - 1;
    snprintf(line, sizeof line, "%.*s", (int)strcspn(at, "\r\n"), at);
    return image_part_parse(line, out);
}

bool image_part_of(const Image *image, ImagePart *out) {
    const ImageAttribute *own = image_attribute(image, IMAGE_PART_NAME), *description = image_attribute(image, "ImageDescription");
    bool found = own && own->text                  ? image_part_parse(own->text, out)
                 : description && description->text ? parse_description(description->text, out)
                                                    : false;
    return found && out->width == image->width && out->height == image->height;
}
