/* --preview: what a viewer is told is the picture, and a viewer that goes away or sleeps does no harm. */
#include "analytic.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <pthread.h>
#include <sys/socket.h>
#include <time.h>

static const char scene[] = LOOK_DOWN(5, 8) "light_source { <3, 10, 2> rgb 1 }\n"
                                            "background { rgb <0.2, 0.4, 0.8> }\n"
                                            "sphere { 0, 3 pigment { checker rgb 1 rgb <1, 0.3, 0> scale 0.7 } }\n";

typedef enum Manner { READS_ALL, LEAVES_EARLY, SLEEPS } Manner;

typedef struct Viewer {
    Manner manner;
    int listener;
    char address[32];
    pthread_t thread;
    int width, height, channels; /* of what was created */
    int created, updated, unknown;
    float *pixels;
    char name[128], channel_names[64];
} Viewer;

static bool read_exactly(int file, void *data, size_t size) {
    for (char *at = data; size > 0;) {
        ssize_t count = recv(file, at, size, 0);
        if (count <= 0) return false;
        at += count, size -= (size_t)count;
    }
    return true;
}

/* The unread rest of a packet. Numbers of the protocol are little-endian, as those of the machines that these tests run on. */
typedef struct Packet {
    const char *at, *end;
} Packet;

static int32_t take_int(Packet *p) {
    int32_t value = 0;
    assert_true(p->end - p->at >= 4);
    memcpy(&value, p->at, 4);
    p->at += 4;
    return value;
}

static int64_t take_long(Packet *p) {
    int64_t value = 0;
    assert_true(p->end - p->at >= 8);
    memcpy(&value, p->at, 8);
    p->at += 8;
    return value;
}

static const char *take_text(Packet *p) {
    const char *text = p->at, *zero = memchr(p->at, 0, (size_t)(p->end - p->at));
    assert_non_null(zero);
    p->at = zero + 1;
    return text;
}

static void take_created(Viewer *v, Packet *p) {
    v->created++;
    snprintf(v->name, sizeof v->name, "%s", take_text(p));
    v->width = take_int(p), v->height = take_int(p), v->channels = take_int(p);
    assert_true(v->width > 0 && v->height > 0 && v->width <= 4096 && v->height <= 4096 && v->channels > 0 && v->channels <= 4);
    v->channel_names[0] = '\0';
    for (int c = 0; c < v->channels; c++) strncat(v->channel_names, take_text(p), 8);
    v->pixels = calloc((size_t)v->width * (size_t)v->height * (size_t)v->channels, sizeof *v->pixels);
}

static void take_updated(Viewer *v, Packet *p) {
    v->updated++;
    assert_string_equal(take_text(p), v->name);
    assert_int_equal(take_int(p), v->channels);
    for (int c = 0; c < v->channels; c++) take_text(p);
    int x = take_int(p), y = take_int(p), w = take_int(p), h = take_int(p);
    int64_t offset[4], stride[4];
    assert_true(x >= 0 && y >= 0 && w > 0 && h > 0 && x + w <= v->width && y + h <= v->height);
    for (int c = 0; c < v->channels; c++) offset[c] = take_long(p);
    for (int c = 0; c < v->channels; c++) stride[c] = take_long(p);
    assert_int_equal(p->end - p->at, 4 * w * h * v->channels);
    for (int i = 0; i < w * h; i++)
        for (int c = 0; c < v->channels; c++)
            memcpy(&v->pixels[((y + i / w) * v->width + x + i % w) * v->channels + c], p->at + 4 * (offset[c] + i * stride[c]), 4);
}

static bool take_packet(Viewer *v, int file) {
    uint32_t size;
    if (!read_exactly(file, &size, 4)) return false;
    assert_true(size > 6 && size < 1 << 20);
    char *data = malloc(size);
    assert_true(read_exactly(file, data + 4, size - 4));
    Packet p = {data + 6, data + size}; /* past size, kind and focus */
    if (data[4] == 4) take_created(v, &p);
    else if (data[4] == 6) take_updated(v, &p);
    else v->unknown++;
    free(data);
    return true;
}

static void *view(void *context) {
    Viewer *v = context;
    int file = accept(v->listener, NULL, NULL);
    if (v->manner == READS_ALL)
        while (take_packet(v, file)) continue;
    if (v->manner == LEAVES_EARLY) take_packet(v, file);
    if (v->manner == SLEEPS) {
        struct timespec pause = {4, 0};
        nanosleep(&pause, NULL);
    }
    close(file);
    return NULL;
}

static void viewer_begin(Viewer *v, Manner manner) {
    *v = (Viewer){.manner = manner, .listener = socket(AF_INET, SOCK_STREAM, 0)};
    struct sockaddr_in place = {.sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    socklen_t size = sizeof place;
    int little = 4096; /* so that a viewer that sleeps is full at once */
    setsockopt(v->listener, SOL_SOCKET, SO_RCVBUF, &little, sizeof little);
    assert_int_equal(bind(v->listener, (struct sockaddr *)&place, sizeof place), 0);
    assert_int_equal(listen(v->listener, 1), 0);
    assert_int_equal(getsockname(v->listener, (struct sockaddr *)&place, &size), 0);
    snprintf(v->address, sizeof v->address, "127.0.0.1:%d", ntohs(place.sin_port));
    assert_int_equal(pthread_create(&v->thread, NULL, view, v), 0);
}

static void viewer_end(Viewer *v) {
    pthread_join(v->thread, NULL);
    close(v->listener);
    free(v->pixels);
    v->pixels = NULL;
}

static void viewers_see_the_picture(void **state) {
    VtsOptions o = options_of_size(100, 70);
    const int region[4] = {5, 3, 90, 70};
    Viewer v;
    viewer_begin(&v, READS_ALL);
    memcpy(o.region, region, sizeof region);
    o.preview = v.address;
    Picture p = bench_render(*state, &o, scene);
    pthread_join(v.thread, NULL);
    assert_int_equal(v.created, 1);
    assert_int_equal(v.unknown, 0);
    assert_int_equal(v.updated, 3 * 3);
    assert_int_equal(v.width, 85);
    assert_int_equal(v.height, 67);
    assert_string_equal(v.channel_names, "RGB");
    assert_memory_equal(v.pixels, p.pixels, 3 * sizeof(float) * 85 * 67);
    picture_free(&p);
    close(v.listener);
    free(v.pixels);
}

static void viewers_that_fail_do_no_harm(void **state) {
    static const Manner manners[] = {LEAVES_EARLY, SLEEPS};
    VtsOptions o = options_of_size(700, 500);
    o.samples = 1;
    Picture alone = bench_render(*state, &o, scene);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(manners); i++) {
        Viewer v;
        viewer_begin(&v, manners[i]);
        o.preview = v.address;
        Picture p = bench_render(*state, &o, scene);
        assert_memory_equal(p.pixels, alone.pixels, 3 * sizeof(float) * 700 * 500);
        picture_free(&p);
        viewer_end(&v);
    }
    picture_free(&alone);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(viewers_see_the_picture),
        cmocka_unit_test(viewers_that_fail_do_no_harm),
    };
    return cmocka_run_group_tests(tests, bench_set_up, bench_tear_down);
}
