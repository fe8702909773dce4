#include "image/palette.h"

#include <stdio.h>
#include <string.h>

static bool read_at(FILE *file, long at, unsigned char *out, size_t size) {
    return fseek(file, at, SEEK_SET) == 0 && fread(out, 1, size, file) == size;
}

static uint32_t big(const unsigned char *b) { return (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3]; }
static uint32_t little(const unsigned char *b) { return (uint32_t)b[3] << 24 | (uint32_t)b[2] << 16 | (uint32_t)b[1] << 8 | b[0]; }

/* Entries of 3 or 4 bytes, red or blue first. */
static bool take_table(FILE *file, long at, uint32_t count, size_t entry, bool blue_first, Palette *out) {
    unsigned char bytes[4 * PALETTE_MOST];
    if (count == 0 || count > PALETTE_MOST || !read_at(file, at, bytes, count * entry)) return false;
    out->count = (int)count;
    for (uint32_t i = 0; i < count; i++)
        for (size_t c = 0; c < 3; c++) out->colors[i][c] = bytes[i * entry + (blue_first ? 2 - c : c)];
    return true;
}

/* Chunks, each with its length and name before it and a sum of four bytes after it; the table comes before the pixels. */
static bool read_png(FILE *file, Palette *out) {
    enum { TYPE_OF_COLOR = 25, NUMBERS = 3, FIRST_CHUNK = 8, MOST_CHUNKS = 1000 };
    unsigned char head[TYPE_OF_COLOR + 1], chunk[8];
    if (!read_at(file, 0, head, sizeof head) || head[TYPE_OF_COLOR] != NUMBERS) return false;
    long at = FIRST_CHUNK;
    for (int i = 0; i < MOST_CHUNKS && read_at(file, at, chunk, sizeof chunk) && memcmp(chunk + 4, "IDAT", 4) != 0; i++) {
        uint32_t length = big(chunk);
        if (memcmp(chunk + 4, "PLTE", 4) == 0) return length % 3 == 0 && take_table(file, at + 8, length / 3, 3, false, out);
        if (length > INT32_MAX || at > INT32_MAX) return false;
        at += (long)length + 12;
    }
    return false;
}

static bool read_gif(FILE *file, Palette *out) {
    unsigned char head[13];
    if (!read_at(file, 0, head, sizeof head) || !(head[10] & 0x80)) return false;
    return take_table(file, sizeof head, 2u << (head[10] & 7), 3, false, out);
}

static bool read_bmp(FILE *file, Palette *out) {
    enum { FILE_HEAD = 14 };
    unsigned char head[50];
    if (!read_at(file, 0, head, sizeof head)) return false;
    uint32_t size = little(head + FILE_HEAD), bits = head[28], used = little(head + 46);
    if (size < 40 || size > 1000 || bits == 0 || bits > 8) return false;
    return take_table(file, (long)(FILE_HEAD + size), used ? used : 1u << bits, 4, true, out);
}

bool palette_read(const char *path, Palette *out) {
    static const struct {
        const char *magic;
        bool (*read)(FILE *file, Palette *out);
    } formats[] = {{"\x89PNG", read_png}, {"GIF8", read_gif}, {"BM", read_bmp}};
    FILE *file = fopen(path, "rb");
    if (!file) return false;
    unsigned char magic[4];
    bool found = false;
    if (read_at(file, 0, magic, sizeof magic))
        for (size_t i = 0; i < VTS_ARRAY_COUNT(formats) && !found; i++)
            if (memcmp(magic, formats[i].magic, strlen(formats[i].magic)) == 0) found = formats[i].read(file, out);
    fclose(file);
    return found;
}

/* ---- numbers ---- */

static int distance(const unsigned char entry[3], const int color[3]) {
    int sum = 0;
    for (int c = 0; c < 3; c++) sum += (entry[c] - color[c]) * (entry[c] - color[c]);
    return sum;
}

static int nearest(const Palette *palette, const int color[3]) {
    int best = 0;
    for (int i = 1; i < palette->count; i++)
        if (distance(palette->colors[i], color) < distance(palette->colors[best], color)) best = i;
    return best;
}

static int code(float value) { return value >= 0 && value <= 255 ? (int)(value + 0.5F) : 0; }

void palette_index(const Palette *palette, Image *image) {
    if (image->stored_as != IMAGE_SAMPLE_U8 || palette->count == 0) return;
    size_t count = (size_t)image->width * (size_t)image->height, channels = (size_t)image->channels;
    int last[3] = {-1, -1, -1}, found = 0; /* neighbours are often alike */
    for (size_t i = 0; i < count; i++) {
        float *pixel = image->pixels + i * channels;
        int color[3];
        for (size_t c = 0; c < 3; c++) color[c] = code(pixel[channels >= 3 ? c : 0]);
        if (memcmp(color, last, sizeof last) != 0) found = nearest(palette, color);
        memcpy(last, color, sizeof last);
        for (size_t c = 0; c < channels; c++) pixel[c] = (float)found;
    }
}
