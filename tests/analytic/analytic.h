/* Renders a scene given as text and reads the picture back: for tests that know what every pixel must be. */
#ifndef VTS_TESTS_ANALYTIC_H
#define VTS_TESTS_ANALYTIC_H

#include "vts.h"

#include "base/vec.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

typedef struct Picture {
    int width, height;
    float *pixels; /* R G B, rows from the top */
} Picture;

static inline const float *pixel_at(const Picture *p, int x, int y) { return p->pixels + 3 * ((size_t)y * (size_t)p->width + (size_t)x); }
static inline void picture_free(Picture *p) {
    free(p->pixels);
    *p = (Picture){0};
}

/* A folder of this process for scenes and pictures; removed with what is in it at the end. */
typedef struct Bench {
    char folder[64], scene[96], output[96];
} Bench;

static inline void bench_begin(Bench *b) {
    strcpy(b->folder, "/tmp/vts-analytic-XXXXXX");
    assert_non_null(mkdtemp(b->folder));
    snprintf(b->scene, sizeof b->scene, "%s/scene.vts", b->folder);
    snprintf(b->output, sizeof b->output, "%s/picture.pfm", b->folder);
}

static inline void bench_end(Bench *b) {
    remove(b->scene);
    remove(b->output);
    remove(b->folder);
}

/* For groups of tests whose state is a Bench. */
static inline int bench_set_up(void **state) {
    Bench *b = malloc(sizeof *b);
    if (!b) return -1;
    bench_begin(b);
    *state = b;
    return 0;
}

static inline int bench_tear_down(void **state) {
    bench_end(*state);
    free(*state);
    return 0;
}

static inline void bench_write(const Bench *b, const char *text) {
    FILE *f = fopen(b->scene, "w");
    assert_non_null(f);
    fputs(text, f);
    fclose(f);
}

/* Portable float maps have their rows from the bottom; numbers of the machine's own order, which the writer chose. */
static inline Picture picture_read(const char *path) {
    FILE *f = fopen(path, "rb");
    assert_non_null(f);
    Picture p;
    double scale;
    char kind[3];
    assert_int_equal(fscanf(f, "%2s %d %d %lf", kind, &p.width, &p.height, &scale), 4);
    assert_string_equal(kind, "PF");
    fgetc(f);
    size_t row = 3 * (size_t)p.width;
    p.pixels = malloc(row * (size_t)p.height * sizeof *p.pixels);
    for (int y = p.height - 1; y >= 0; y--) assert_int_equal(fread(p.pixels + row * (size_t)y, sizeof(float), row, f), row);
    fclose(f);
    return p;
}

static inline VtsStatus bench_try(const Bench *b, const VtsOptions *options, const char *text) {
    bench_write(b, text);
    VtsSession *session = vts_session_create(options, NULL);
    assert_non_null(session);
    VtsStatus status = vts_render(session, b->scene, b->output);
    if (status == VTS_ERROR_SCENE || status == VTS_ERROR_USAGE || status == VTS_ERROR_FILE) fputs(vts_diagnostics(session), stdout);
    vts_session_destroy(session);
    return status;
}

static inline Picture bench_render(const Bench *b, const VtsOptions *options, const char *text) {
    assert_int_equal(bench_try(b, options, text), VTS_OK);
    return picture_read(b->output);
}

/* As it is drawn, or by the reference. */
static inline Picture bench_see(const Bench *b, const VtsOptions *options, const char *text, bool exact) {
    if (!exact) return bench_render(b, options, text);
    bench_write(b, text);
    VtsSession *session = vts_session_create(options, NULL);
    assert_non_null(session);
    assert_int_equal(vts_reference(session, b->scene, b->output), VTS_OK);
    vts_session_destroy(session);
    return picture_read(b->output);
}

static inline VtsOptions options_of_size(int width, int height) {
    VtsOptions o = vts_options_default();
    o.width = width, o.height = height, o.threads = 2;
    return o;
}

/* Mean and largest difference of two pictures of one size, over their values. */
typedef struct Difference {
    double mean, rms, most;
} Difference;

static inline Difference picture_difference(const Picture *a, const Picture *b) {
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    Difference d = {0};
    size_t n = 3 * (size_t)a->width * (size_t)a->height;
    for (size_t i = 0; i < n; i++) {
        double e = (double)a->pixels[i] - (double)b->pixels[i];
        d.mean += e, d.rms += e * e, d.most = fmax(d.most, fabs(e));
    }
    d.mean /= (double)n, d.rms = sqrt(d.rms / (double)n);
    return d;
}

static inline double picture_mean(const Picture *p) {
    double sum = 0;
    size_t n = 3 * (size_t)p->width * (size_t)p->height;
    for (size_t i = 0; i < n; i++) sum += (double)p->pixels[i];
    return sum / (double)n;
}

/* Mean light of what bench_see() sees. */
static inline double bench_mean(const Bench *b, const VtsOptions *options, const char *text, bool exact) {
    Picture p = bench_see(b, options, text, exact);
    double mean = picture_mean(&p);
    picture_free(&p);
    return mean;
}

/* Of a report: the number behind the key, which is there. */
static inline double number_after(const char *text, const char *key) {
    const char *at = strstr(text, key);
    assert_non_null(at);
    return strtod(at + strlen(key), NULL);
}

/* The camera of these scenes looks down along -y from height `h`: orthographic, `side` wide and high; the upper edge lies
 * towards +z, the right one towards +x. */
#define LOOK_DOWN(h, side) "camera { orthographic location <0," #h ",0> direction <0,-1,0> right " #side "*x up " #side "*z }\n"

#endif
