#include "image/pnm.h"

#include "base/decimal.h"
#include "image/image_part.h"
#include "image/srgb.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The unread rest of the file. */
typedef struct Reader {
    const unsigned char *at, *end;
} Reader;

enum { LONGEST_WORD = 127 };
/* What comes before a part's place in the decimals of PFM's scale. */
#define SCALE_OF_PART "-1.000000000000000000000000"

typedef struct PnmHeader {
    int width, height, channels;
    int largest;     /* code; 0 for PFM */
    bool text;       /* P2, P3: codes as decimal digits */
    bool big_endian; /* PFM */
    ImagePart part;  /* 0 wide: it is none */
} PnmHeader;

bool pnm_recognizes(const unsigned char *data, size_t size) {
    return size >= 3 && data[0] == 'P' && data[1] && strchr("fF2356", data[1]) &&
           strchr(" \t\r\n#", data[2]) && data[2];
}

static bool is_space(unsigned char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

static void skip_space_and_comments(Reader *reader) {
    while (reader->at < reader->end && (is_space(*reader->at) || *reader->at == '#'))
        if (*reader->at == '#')
            while (reader->at < reader->end && *reader->at != '\n') reader->at++;
        else
            reader->at++;
}

/* A comment "# vts:part …" between here and the next number. */
static void find_part(Reader reader, ImagePart *out) {
    static const char mark[] = "# " IMAGE_PART_NAME " ";
    for (; reader.at < reader.end && is_space(*reader.at); reader.at++) continue;
    if ((size_t)(reader.end - reader.at) < sizeof mark || memcmp(reader.at, mark, sizeof mark - 1) != 0) return;
    char text[LONGEST_WORD + 1];
    size_t size = 0;
    for (reader.at += sizeof mark - 1; reader.at < reader.end && *reader.at != '\n' && size < LONGEST_WORD; reader.at++)
        text[size++] = (char)*reader.at;
    text[size] = '\0';
    if (!image_part_parse(text, out)) *out = (ImagePart){0};
}

/* A decimal number of the header or of a text raster, at most `largest`; -1 when there is none. */
static int read_number(Reader *reader, int largest) {
    skip_space_and_comments(reader);
    int64_t value = 0;
    const unsigned char *begin = reader->at;
    for (; reader->at < reader->end && *reader->at >= '0' && *reader->at <= '9'; reader->at++) {
        value = value * 10 + (*reader->at - '0');
        if (value > largest) return -1;
    }
    return reader->at > begin ? (int)value : -1;
}

static void read_part_digits(const char *word, ImagePart *out) {
    int n[6];
    char text[LONGEST_WORD + 1];
    uint64_t key;
    if (strncmp(word, SCALE_OF_PART, sizeof SCALE_OF_PART - 1) != 0) return;
    if (sscanf(word + sizeof SCALE_OF_PART - 1, "%7d%7d%7d%7d%7d%7d%20" SCNu64, &n[0], &n[1], &n[2], &n[3], &n[4], &n[5], &key) != 7) return;
    snprintf(text, sizeof text, "%d,%d,%d,%d of %dx%d %016" PRIx64, n[0], n[1], n[2], n[3], n[4], n[5], key);
    if (!image_part_parse(text, out)) *out = (ImagePart){0};
}

/* PFM's scale: only its sign has a settled meaning (negative: little-endian). */
static bool read_scale(Reader *reader, double *scale, ImagePart *part) {
    char word[LONGEST_WORD + 1];
    size_t size = 0;
    skip_space_and_comments(reader);
    while (reader->at < reader->end && !is_space(*reader->at) && size + 1 < sizeof word)
        word[size++] = (char)*reader->at++;
    word[size] = '\0';
    char *end;
    *scale = decimal_strtod(word, &end);
    read_part_digits(word, part);
    return size > 0 && !*end && *scale != 0;
}

static const char *read_header(Reader *reader, PnmHeader *header) {
    unsigned char kind = reader->at[1];
    reader->at += 2;
    header->channels = strchr("F36", kind) ? 3 : 1;
    header->text = kind == '2' || kind == '3';
    header->width = read_number(reader, IMAGE_LARGEST_SIDE);
    header->height = read_number(reader, IMAGE_LARGEST_SIDE);
    find_part(*reader, &header->part);
    if (header->width < 1 || header->height < 1) return "its width or height is missing or out of range";
    if (kind == 'f' || kind == 'F') {
        double scale;
        if (!read_scale(reader, &scale, &header->part)) return "its scale is not a number";
        header->big_endian = scale > 0;
    } else if ((header->largest = read_number(reader, 65535)) < 1) {
        return "its largest value is not between 1 and 65535";
    }
    /* Exactly one white space ends the header of a binary raster. */
    if (reader->at >= reader->end || !is_space(*reader->at)) return "its header does not end";
    reader->at++;
    return NULL;
}

static size_t bytes_per_sample(const PnmHeader *header) {
    return header->largest == 0 ? 4 : header->largest > 255 ? 2 : 1;
}

static float float_at(const unsigned char *p, bool big_endian) {
    uint32_t bits = big_endian ? (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3]
                               : (uint32_t)p[3] << 24 | (uint32_t)p[2] << 16 | (uint32_t)p[1] << 8 | p[0];
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* PFM's rows go from the bottom to the top. */
static void read_floats(const Reader *reader, const PnmHeader *header, float *pixels) {
    size_t row = (size_t)header->width * (size_t)header->channels;
    for (size_t y = 0; y < (size_t)header->height; y++) {
        float *to = pixels + ((size_t)header->height - 1 - y) * row;
        for (size_t i = 0; i < row; i++) to[i] = float_at(reader->at + 4 * (y * row + i), header->big_endian);
    }
}

static bool read_codes(Reader *reader, const PnmHeader *header, ImageReading reading, float *pixels) {
    size_t count = (size_t)header->width * (size_t)header->height * (size_t)header->channels;
    for (size_t i = 0; i < count; i++) {
        int code;
        if (header->text)
            code = read_number(reader, header->largest);
        else if (header->largest > 255)
            code = reader->at[2 * i] << 8 | reader->at[2 * i + 1];
        else
            code = reader->at[i];
        if (code < 0 || code > header->largest) return false;
        pixels[i] =
            reading == IMAGE_AS_STORED ? (float)code : (float)srgb_decode((double)code / header->largest);
    }
    return true;
}

static bool fail(StrBuf *error, const char *path, const char *why) {
    if (error) strbuf_addf(error, "cannot read '%s': %s", path, why);
    return false;
}

bool pnm_decode(Image *image, const unsigned char *data, size_t size, const char *path, ImageReading reading,
                MemoryBudget *budget, StrBuf *error) {
    Reader reader = {data, data + size};
    PnmHeader header = {0};
    const char *wrong = read_header(&reader, &header);
    if (wrong) return fail(error, path, wrong);
    /* Known to fit before anything of that size is asked for: a text raster has a digit and a space for each sample. */
    size_t samples = (size_t)header.width * (size_t)header.height * (size_t)header.channels;
    size_t rest = (size_t)(reader.end - reader.at);
    if (header.text ? rest / 2 + 1 < samples : rest / bytes_per_sample(&header) < samples)
        return fail(error, path, "it ends before the last pixel");
    if (!image_init(image, header.width, header.height, header.channels, NULL, budget, error)) return false;
    image->stored_as = header.largest == 0    ? IMAGE_SAMPLE_FLOAT
                       : header.largest > 255 ? IMAGE_SAMPLE_U16
                                              : IMAGE_SAMPLE_U8;
    image->colour_stored_as = image->stored_as;
    image->coded = reading == IMAGE_AS_STORED && header.largest > 0;
    if (header.part.width > 0) image_part_set(image, &header.part);
    if (header.largest == 0) {
        read_floats(&reader, &header, image->pixels);
        return true;
    }
    if (read_codes(&reader, &header, reading, image->pixels)) return true;
    image_free(image);
    return fail(error, path, "a sample is missing or past the largest value");
}

void pnm_add_pfm_header(StrBuf *out, const Image *image, int channels) {
    ImagePart p;
    strbuf_addf(out, "%s\n%d %d\n", channels == 1 ? "Pf" : "PF", image->width, image->height);
    if (image_part_of(image, &p))
        strbuf_addf(out, SCALE_OF_PART "%07d%07d%07d%07d%07d%07d%020" PRIu64 "\n", p.x, p.y, p.x + p.width, p.y + p.height, p.whole_width,
                    p.whole_height, p.key);
    else
        strbuf_adds(out, "-1.0\n");
}

void pnm_add_header(StrBuf *out, const Image *image, int channels, int largest) {
    ImagePart part;
    strbuf_addf(out, "%s\n%d %d\n", channels == 1 ? "P5" : "P6", image->width, image->height);
    if (image_part_of(image, &part)) {
        strbuf_adds(out, "# " IMAGE_PART_NAME " ");
        image_part_print(&part, out);
        strbuf_addc(out, '\n');
    }
    strbuf_addf(out, "%d\n", largest);
}

bool pnm_floats_are_own(void) {
    static const uint16_t one = 1;
    return *(const unsigned char *)&one == 1;
}

void pnm_floats_to_file(float *samples, size_t count) {
    if (pnm_floats_are_own()) return;
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &samples[i], sizeof bits);
        const unsigned char bytes[4] = {(unsigned char)(bits & 0xFF), (unsigned char)(bits >> 8 & 0xFF), (unsigned char)(bits >> 16 & 0xFF),
                                        (unsigned char)(bits >> 24)};
        memcpy(&samples[i], bytes, sizeof bytes);
    }
}

void pnm_add_codes(StrBuf *out, const uint16_t *codes, size_t count, bool wide) {
    for (size_t i = 0; i < count; i++) {
        char bytes[2] = {(char)(codes[i] >> 8), (char)(codes[i] & 0xFF)};
        strbuf_add(out, wide ? bytes : bytes + 1, wide ? 2 : 1);
    }
}
