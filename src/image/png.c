#include "image/png.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* What is packed goes into chunks of this size. */
enum { MOST_CHUNK = 1 << 20, FILTERS = 5, LEVEL = 6 };

/* ---- chunks ---- */

static void put_u32(unsigned char *to, uint32_t value) {
    for (int i = 0; i < 4; i++) to[i] = (unsigned char)(value >> (24 - 8 * i));
}

/* Of a size that fits: at most MOST_CHUNK, or a text's. */
static void add_chunk(StrBuf *out, const char *kind, const void *data, size_t size) {
    unsigned char head[8], check[4];
    put_u32(head, (uint32_t)size);
    memcpy(head + 4, kind, 4);
    uLong crc = crc32(crc32(0, NULL, 0), head + 4, 4);
    if (size) crc = crc32(crc, data, (uInt)size);
    put_u32(check, (uint32_t)crc);
    strbuf_add(out, (const char *)head, sizeof head);
    if (size) strbuf_add(out, data, size);
    strbuf_add(out, (const char *)check, sizeof check);
}

static void add_header(StrBuf *out, const PngPicture *p) {
    static const unsigned char colour_types[] = {0, 0, 4, 2, 6}; /* by channels */
    unsigned char data[13] = {0};
    put_u32(data, (uint32_t)p->width);
    put_u32(data + 4, (uint32_t)p->height);
    data[8] = p->wide ? 16 : 8;
    data[9] = colour_types[p->channels];
    add_chunk(out, "IHDR", data, sizeof data);
}

/* Whoever does not know sRGB knows gamma. */
static void add_colour_space(StrBuf *out) {
    static const unsigned char perceptual[1] = {0};
    unsigned char gamma[4];
    put_u32(gamma, 45455);
    add_chunk(out, "gAMA", gamma, sizeof gamma);
    add_chunk(out, "sRGB", perceptual, sizeof perceptual);
}

/* ---- texts ---- */

static bool is_plain(const char *text) {
    for (; *text; text++)
        if ((unsigned char)*text >= 0x80) return false;
    return true;
}

/* A keyword of at most 79 characters; what is not ASCII is UTF-8, which iTXt holds. */
static void add_text(StrBuf *out, const ImageAttribute *attribute) {
    enum { LONGEST_KEYWORD = 79, LONGEST_TEXT = 1 << 24 };
    const char *name = attribute->name;
    StrBuf text = {0}, data = {0};
    if (attribute->text)
        strbuf_adds(&text, attribute->text);
    else
        strbuf_addf(&text, "%.17g", attribute->number);
    bool plain = !text.size || is_plain(text.data);
    strbuf_add(&data, name, strlen(name) + 1);
    if (!plain) strbuf_add(&data, "\0\0\0\0", 4); /* not packed; no language, no translated keyword */
    if (text.size) strbuf_add(&data, text.data, text.size);
    if (*name && strlen(name) <= LONGEST_KEYWORD && is_plain(name) && text.size <= LONGEST_TEXT)
        add_chunk(out, plain ? "tEXt" : "iTXt", data.data, data.size);
    strbuf_free(&text);
    strbuf_free(&data);
}

/* ---- rows ---- */

static int paeth(int left, int above, int both) {
    int guess = left + above - both, a = abs(guess - left), b = abs(guess - above), c = abs(guess - both);
    return a <= b && a <= c ? left : b <= c ? above : both;
}

static int predicted(int filter, int left, int above, int both) {
    switch (filter) {
    case 1: return left;
    case 2: return above;
    case 3: return (left + above) / 2;
    case 4: return paeth(left, above, both);
    default: return 0;
    }
}

/* Into out[0 … size], its first byte the filter's number. Returns how far the bytes are from zero, all told. */
static size_t filter_row(int filter, const unsigned char *row, const unsigned char *before, size_t size,
                         size_t pixel, unsigned char *out) {
    size_t sum = 0;
    *out++ = (unsigned char)filter;
    for (size_t i = 0; i < size; i++) {
        bool first = i < pixel;
        int off = (row[i] -
                   predicted(filter, first ? 0 : row[i - pixel], before[i], first ? 0 : before[i - pixel])) &
                  0xFF;
        out[i] = (unsigned char)off;
        sum += (size_t)(off < 128 ? off : 256 - off);
    }
    return sum;
}

static void bytes_of_row(const PngPicture *p, int y, size_t samples, unsigned char *row) {
    const uint16_t *codes = p->codes + (size_t)y * samples;
    for (size_t i = 0; i < samples; i++) {
        if (p->wide) *row++ = (unsigned char)(codes[i] >> 8);
        *row++ = (unsigned char)codes[i];
    }
}

/* Rows by the filter that leaves the smallest numbers, as the standard advises. */
static void filter_rows(const PngPicture *p, size_t samples, size_t size, unsigned char *work,
                        unsigned char *out) {
    const size_t pixel = (size_t)p->channels * (p->wide ? 2 : 1);
    unsigned char *row = work, *before = work + size, *tried = work + 2 * size;
    memset(before, 0, size);
    for (int y = 0; y < p->height; y++, out += size + 1) {
        bytes_of_row(p, y, samples, row);
        size_t least = SIZE_MAX;
        for (int filter = 0; filter < FILTERS; filter++) {
            size_t sum = filter_row(filter, row, before, size, pixel, tried);
            if (sum >= least) continue;
            least = sum;
            memcpy(out, tried, size + 1);
        }
        unsigned char *swap = row;
        row = before, before = swap;
    }
}

static void add_packed(StrBuf *out, const unsigned char *packed, size_t size) {
    for (size_t i = 0; i < size; i += MOST_CHUNK)
        add_chunk(out, "IDAT", packed + i, size - i < MOST_CHUNK ? size - i : MOST_CHUNK);
}

bool png_encode(const PngPicture *p, StrBuf *out) {
    const size_t samples = (size_t)p->width * (size_t)p->channels, size = samples * (p->wide ? 2 : 1),
                 total = (size + 1) * (size_t)p->height;
    uLongf packed_size = compressBound((uLong)total);
    unsigned char *work = malloc(3 * size + 1), *rows = malloc(total), *packed = malloc(packed_size);
    bool done = work && rows && packed;
    if (done) {
        filter_rows(p, samples, size, work, rows);
        done = compress2(packed, &packed_size, rows, (uLong)total, LEVEL) == Z_OK;
    }
    if (done) {
        strbuf_add(out, "\x89PNG\r\n\x1A\n", 8);
        add_header(out, p);
        add_colour_space(out);
        for (size_t i = 0; i < p->attribute_count; i++) add_text(out, &p->attributes[i]);
        add_packed(out, packed, packed_size);
        add_chunk(out, "IEND", NULL, 0);
    }
    free(work);
    free(rows);
    free(packed);
    return done;
}
