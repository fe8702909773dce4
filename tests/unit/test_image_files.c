/* Pictures through files: round trips of every format, equal bytes for equal pictures, metadata, files that lie. */
#include "image/image.h"
#include "image/srgb.h"
#include "image/whole_file.h"

#include "base/random.h"

#include <dirent.h>
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

enum { WIDTH = 37, HEIGHT = 23 };

/* Every test has a folder of its own, which must be empty but for what the test expects. */
typedef struct Fixture {
    char folder[64];
    char path[128];
    StrBuf error;
} Fixture;

static int set_up(void **state) {
    Fixture *f = calloc(1, sizeof *f);
    strcpy(f->folder, "/tmp/vts-image-XXXXXX");
    if (!f || !mkdtemp(f->folder)) return -1;
    *state = f;
    return 0;
}

static size_t remove_all(const char *folder) {
    size_t count = 0;
    DIR *stream = opendir(folder);
    for (struct dirent *entry; stream && (entry = readdir(stream));) {
        if (entry->d_name[0] == '.') continue;
        char path[512];
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        unlink(path);
        count++;
    }
    if (stream) closedir(stream);
    return count;
}

static int tear_down(void **state) {
    Fixture *f = *state;
    remove_all(f->folder);
    rmdir(f->folder);
    strbuf_free(&f->error);
    free(f);
    return 0;
}

static const char *in_folder(Fixture *f, const char *name) {
    snprintf(f->path, sizeof f->path, "%s/%s", f->folder, name);
    return f->path;
}

/* Values in [0,1] with the ends, some tiny ones, and, where `wide`, values past 1 and below 0. */
static void fill(Image *image, bool wide) {
    RandomStream random = {7};
    size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    for (size_t i = 0; i < count; i++) {
        double u = random_next_unit(&random);
        double value = i % 11 == 0 ? 0 : i % 11 == 1 ? 1 : i % 11 == 2 ? u * 1e-3 : u;
        if (wide && i % 11 == 3) value = ldexp(u, (int)(random_next(&random) % 24) - 10) * (i % 2 ? 1 : -1);
        image->pixels[i] = (float)value;
    }
}

static Image make(int channels, const char *const *names, bool wide) {
    Image image;
    assert_true(image_init(&image, WIDTH, HEIGHT, channels, names, NULL, NULL));
    fill(&image, wide);
    return image;
}

static void save(Fixture *f, const Image *image, const char *name, ImageSample sample) {
    if (!image_save(image, in_folder(f, name), sample, &f->error)) fail_msg("%s", f->error.data);
}

static Image load(Fixture *f, const char *name, ImageReading reading) {
    Image image;
    if (!image_load(&image, in_folder(f, name), reading, NULL, &f->error)) fail_msg("%s", f->error.data);
    return image;
}

static size_t sample_count(const Image *image) {
    return (size_t)image->width * (size_t)image->height * (size_t)image->channels;
}

static void assert_same_shape(const Image *a, const Image *b) {
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_int_equal(a->channels, b->channels);
}

static void test_float_formats_are_exact(void **state) {
    Fixture *f = *state;
    const char *names[] = {"grey.pfm", "rgb.pfm", "rgb.exr", "rgba.exr"};
    const int channels[] = {1, 3, 3, 4};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(names); i++) {
        Image out = make(channels[i], NULL, true);
        save(f, &out, names[i], IMAGE_SAMPLE_FLOAT);
        Image in = load(f, names[i], IMAGE_AS_COLOUR);
        assert_same_shape(&out, &in);
        assert_int_equal(in.stored_as, IMAGE_SAMPLE_FLOAT);
        assert_memory_equal(out.pixels, in.pixels, sample_count(&out) * sizeof(float));
        image_free(&in);
        image_free(&out);
    }
}

/* Half a unit in the last place of a half: 11 bits of mantissa, 2^-24 the smallest step. */
static double half_ulp_of_half(double x) {
    return ldexp(1, (int)fmax(ilogb(fmax(fabs(x), 1e-30)), -14) - 11);
}

static void test_half_exr_and_float_channels(void **state) {
    Fixture *f = *state;
    const char *const names[] = {"R", "G", "B", "A", "Z", "normal.x", "texel_level"};
    Image out = make(7, names, true);
    out.pixels[0] = 1e6f; /* past the largest half: stays finite */
    save(f, &out, "all.exr", IMAGE_SAMPLE_AUTO);
    Image in = load(f, "all.exr", IMAGE_AS_COLOUR);
    assert_int_equal(in.channels, 7);
    assert_float_equal(image_pixel(&in, 0, 0)[image_channel(&in, "R")], 65504, 0);
    for (int c = 0; c < 7; c++) {
        int from = image_channel(&in, names[c]);
        assert_true(from >= 0);
        for (int i = 1; i < WIDTH * HEIGHT; i++) {
            double a = (double)out.pixels[i * 7 + c], b = (double)in.pixels[i * 7 + from];
            if (fabs(a - b) > (c < 4 ? half_ulp_of_half(a) : 0))
                fail_msg("%s of pixel %d: %.9g became %.9g", names[c], i, a, b);
        }
    }
    image_free(&in);
    image_free(&out);
}

/* The codes that 8- and 16-bit files must hold, from the closed form in long double. */
static long expected_code(double linear, double largest) {
    long double x = linear < 0 ? 0 : linear > 1 ? 1 : (long double)linear;
    long double code = x <= 0.0031308L ? 12.92L * x : 1.055L * powl(x, 1 / 2.4L) - 0.055L;
    return lrintl(code * (long double)largest);
}

static void check_codes(Fixture *f, const char *name, int channels, ImageSample sample, long largest) {
    Image out = make(channels, NULL, true);
    save(f, &out, name, sample);
    Image in = load(f, name, IMAGE_AS_STORED), decoded = load(f, name, IMAGE_AS_COLOUR);
    assert_same_shape(&out, &in);
    assert_int_equal(in.stored_as, largest == 255 ? IMAGE_SAMPLE_U8 : IMAGE_SAMPLE_U16);
    for (size_t i = 0; i < sample_count(&out); i++) {
        long want = expected_code((double)out.pixels[i], (double)largest), got = lrintf(in.pixels[i]);
        /* One off only where the exact code lies on the border of two. */
        double exact = srgb_encode((double)out.pixels[i]) * (double)largest;
        if (got != want && fabs(fabs(exact - floor(exact)) - 0.5) > 1e-6)
            fail_msg("%s sample %zu: %ld, not %ld", name, i, got, want);
        double back = srgb_decode((double)got / (double)largest);
        assert_true(fabs(back - (double)decoded.pixels[i]) <= 1e-6 * back);
    }
    image_free(&decoded);
    image_free(&in);
    image_free(&out);
}

static void test_integer_formats_hold_rounded_codes(void **state) {
    Fixture *f = *state;
    check_codes(f, "a.png", 3, IMAGE_SAMPLE_AUTO, 255);
    check_codes(f, "b.png", 3, IMAGE_SAMPLE_U16, 65535);
    check_codes(f, "c.png", 1, IMAGE_SAMPLE_U8, 255);
    check_codes(f, "d.tif", 3, IMAGE_SAMPLE_AUTO, 65535);
    check_codes(f, "e.tiff", 3, IMAGE_SAMPLE_U8, 255);
    check_codes(f, "f.ppm", 3, IMAGE_SAMPLE_AUTO, 255);
    check_codes(f, "g.ppm", 3, IMAGE_SAMPLE_U16, 65535);
    check_codes(f, "h.pgm", 1, IMAGE_SAMPLE_U8, 255);
    check_codes(f, "i.pgm", 1, IMAGE_SAMPLE_U16, 65535);
}

/* Associated alpha in memory, unassociated in the file, whatever the order of the channels. */
static void check_alpha(Fixture *f, const char *name) {
    const char *const names[] = {"A", "R", "G", "B"};
    Image out = make(4, names, false);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        for (int c = 1; c < 4; c++) out.pixels[4 * i + c] *= out.pixels[4 * i];
    save(f, &out, name, IMAGE_SAMPLE_U16);
    Image in = load(f, name, IMAGE_AS_COLOUR);
    assert_int_equal(in.channels, 4);
    const char *const order[] = {"R", "G", "B", "A"};
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        for (int c = 0; c < 4; c++) {
            double a = (double)out.pixels[4 * i + image_channel(&out, order[c])];
            double b = (double)in.pixels[4 * i + image_channel(&in, order[c])];
            if (fabs(a - b) > 3e-5) fail_msg("%s %s of pixel %d: %g became %g", name, order[c], i, a, b);
        }
    image_free(&in);
    image_free(&out);
}

static void test_alpha_survives(void **state) {
    check_alpha(*state, "alpha.png");
    check_alpha(*state, "alpha.tif");
}

/* Lossy ones: near. HDR shares an exponent among three, JPEG is given a smooth picture. */
static void test_lossy_formats_are_near(void **state) {
    Fixture *f = *state;
    Image out = make(3, NULL, false);
    save(f, &out, "a.hdr", IMAGE_SAMPLE_AUTO);
    Image in = load(f, "a.hdr", IMAGE_AS_COLOUR);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const float *p = out.pixels + 3 * i, *q = in.pixels + 3 * i;
        float step = float_max(float_max(p[0], p[1]), p[2]) / 100;
        for (int c = 0; c < 3; c++) assert_true(fabsf(p[c] - q[c]) <= step);
    }
    image_free(&in);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            for (int c = 0; c < 3; c++)
                image_pixel(&out, x, y)[c] =
                    (float)srgb_decode((double)(x + 2 * y) / (WIDTH + 2 * HEIGHT) * 0.8 + 0.1);
    save(f, &out, "a.jpg", IMAGE_SAMPLE_AUTO);
    in = load(f, "a.jpg", IMAGE_AS_COLOUR);
    for (size_t i = 0; i < sample_count(&out); i++)
        assert_true(fabs(srgb_encode((double)in.pixels[i]) - srgb_encode((double)out.pixels[i])) < 0.03);
    image_free(&in);
    image_free(&out);
}

static const char *const ALL_SUFFIXES[] = {"exr", "png", "tif", "jpg", "hdr", "pfm", "ppm", "pgm"};

static void test_equal_pictures_are_equal_files(void **state) {
    Fixture *f = *state;
    Image image = make(3, NULL, false);
    image_set_text(&image, "vts:scene", "lawn");
    for (size_t i = 0; i < VTS_ARRAY_COUNT(ALL_SUFFIXES); i++) {
        char name[2][16];
        unsigned char *bytes[2];
        size_t size[2];
        for (int k = 0; k < 2; k++) {
            snprintf(name[k], sizeof name[k], "%d.%s", k, ALL_SUFFIXES[i]);
            /* A second between them is what a time stamp would show; only these two formats have one. */
            if (k == 1 && i == 0) sleep(1);
            save(f, &image, name[k], IMAGE_SAMPLE_AUTO);
            bytes[k] = whole_file_read(f->path, &size[k], NULL);
            assert_non_null(bytes[k]);
        }
        assert_int_equal(size[0], size[1]);
        assert_memory_equal(bytes[0], bytes[1], size[0]);
        for (int k = 0; k < 2; k++) {
            StrBuf all = {0};
            for (size_t b = 0; b < size[k]; b++) strbuf_addc(&all, bytes[k][b] ? (char)bytes[k][b] : ' ');
            assert_null(strstr(all.data, "202")); /* no year of ours */
            strbuf_free(&all);
            free(bytes[k]);
        }
    }
    image_free(&image);
}

static void test_metadata_come_back(void **state) {
    Fixture *f = *state;
    Image out = make(3, NULL, false);
    image_set_text(&out, "vts:scene", "lawn.vts");
    image_set_number(&out, "vts:clock", 0.1);
    image_set_number(&out, "vts:clock", 1.0 / 3);
    assert_int_equal(out.attribute_count, 2);
    save(f, &out, "m.exr", IMAGE_SAMPLE_AUTO);
    save(f, &out, "m.png", IMAGE_SAMPLE_AUTO);
    save(f, &out, "m.tif", IMAGE_SAMPLE_AUTO);
    save(f, &out, "m.jpg", IMAGE_SAMPLE_AUTO);

    Image in = load(f, "m.exr", IMAGE_AS_COLOUR);
    const ImageAttribute *scene = image_attribute(&in, "vts:scene"),
                         *clock = image_attribute(&in, "vts:clock");
    assert_true(scene && scene->text && clock && !clock->text);
    assert_string_equal(scene->text, "lawn.vts");
    assert_true(clock->number == 1.0 / 3);
    image_free(&in);

    in = load(f, "m.png", IMAGE_AS_COLOUR);
    scene = image_attribute(&in, "vts:scene");
    clock = image_attribute(&in, "vts:clock");
    assert_true(scene && scene->text && clock && clock->text);
    assert_string_equal(scene->text, "lawn.vts");
    assert_true(strtod(clock->text, NULL) == 1.0 / 3);
    image_free(&in);

    const char *described[] = {"m.tif", "m.jpg"};
    for (int i = 0; i < 2; i++) {
        in = load(f, described[i], IMAGE_AS_COLOUR);
        const ImageAttribute *lines = image_attribute(&in, "ImageDescription");
        assert_true(lines && lines->text && strstr(lines->text, "vts:scene=lawn.vts\n"));
        image_free(&in);
    }
    image_free(&out);
}

static void assert_refused(Fixture *f, const char *name, const void *data, size_t size) {
    Image image;
    assert_true(whole_file_replace(in_folder(f, name), data, size, NULL));
    strbuf_clear(&f->error);
    if (image_load(&image, f->path, IMAGE_AS_COLOUR, NULL, &f->error))
        fail_msg("%s of %zu bytes was read", name, size);
    assert_true(f->error.size > 0);
    assert_null(strchr(f->error.data, '\n'));
    assert_null(image.pixels);
}

static void test_lying_headers_are_refused(void **state) {
    static const char *const lies[] = {
        "P6\n2 2\n255\n",
        "P6\n1048576 1048576\n255\nxxxx",
        "P6\n-2 2\n255\nxxxxxxxxxxxx",
        "P6\n0 2\n255\n",
        "P6\n2 2\n0\nxxxxxxxxxx",
        "P6\n2 2\n65536\nxxxxxxxxxxxxxxxxxxxxxxxxx",
        "P6\n99999999999999999999 2\n255\nx",
        "P6 2",
        "P5\n2 2\n100\n\x01\x02\x03\x65",
        "P5\n4 1\n65535\n1234567",
        "P2\n2 2\n9\n1 2 3",
        "P2\n2 2\n9\n1 2 3 x",
        "P2\n2 2\n9\n1 2 3 10",
        "P3\n1 1\n255\n1 2",
        "PF\n2 2\n-1\nxxxx",
        "Pf\n1 1\n0\nxxxx",
        "Pf\n1 1\nabc\nxxxx",
        "Pf\n1 1\n-1.0",
        "Pf\n1\n",
        "PF # a comment that never ends",
        "P6\n# one\n",
    };
    for (size_t i = 0; i < VTS_ARRAY_COUNT(lies); i++)
        assert_refused(*state, "lie.ppm", lies[i], strlen(lies[i]));
}

static void test_every_truncation_is_refused(void **state) {
    Fixture *f = *state;
    Image image = make(3, NULL, false);
    const char *names[] = {"t.pfm", "t.ppm", "t.png", "t.exr", "t.tif"};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(names); i++) {
        save(f, &image, names[i], IMAGE_SAMPLE_AUTO);
        size_t size;
        unsigned char *bytes = whole_file_read(f->path, &size, NULL);
        bool ours = i < 2;
        /* Libraries may repair the end of a file that lacks only a trailer. */
        for (size_t cut = 0; cut < (ours ? size : size / 2); cut += size / (ours ? 50 : 20) + 1)
            assert_refused(f, names[i], bytes, cut);
        free(bytes);
    }
    image_free(&image);
}

/* Any result will do but a crash, or a picture of another size than its header says. */
static void test_damage_does_no_harm(void **state) {
    Fixture *f = *state;
    Image image = make(3, NULL, false);
    const char *names[] = {"d.pfm", "d.ppm", "d.png", "d.exr"};
    RandomStream random = {11};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(names); i++) {
        save(f, &image, names[i], IMAGE_SAMPLE_AUTO);
        size_t size;
        unsigned char *bytes = whole_file_read(f->path, &size, NULL);
        for (int round = 0; round < 30; round++) {
            unsigned char *damaged = malloc(size);
            memcpy(damaged, bytes, size);
            size_t reach = round % 2 ? size_min(size, 40) : size;
            for (int k = 0; k < 3; k++)
                damaged[random_next(&random) % reach] = (unsigned char)random_next(&random);
            Image in;
            assert_true(whole_file_replace(f->path, damaged, size, NULL));
            if (image_load(&in, f->path, IMAGE_AS_COLOUR, NULL, NULL)) image_free(&in);
            free(damaged);
        }
        free(bytes);
    }
    image_free(&image);
}

static void test_pnm_reads_text_comments_and_both_endians(void **state) {
    Fixture *f = *state;
    const char text[] = "P3 # a comment\n2 1 # another\n10\n10 0 5\n # within\n0 10 3";
    assert_true(whole_file_replace(in_folder(f, "a.ppm"), text, strlen(text), NULL));
    Image in = load(f, "a.ppm", IMAGE_AS_STORED);
    const float want[] = {10, 0, 5, 0, 10, 3};
    assert_int_equal(in.width, 2);
    assert_memory_equal(in.pixels, want, sizeof want);
    image_free(&in);
    /* 1.0f is 3F800000; the first row of the file is the bottom one. */
    const char big[] = "Pf\n1 2\n1.0\n\x40\0\0\0\x3F\x80\0\0",
               little[] = "Pf\n1 2\n-1.0\n\0\0\0\x40\0\0\x80\x3F";
    const struct {
        const char *bytes;
        size_t size;
    } files[] = {{big, sizeof big - 1}, {little, sizeof little - 1}};
    for (int i = 0; i < 2; i++) {
        assert_true(whole_file_replace(in_folder(f, "a.pfm"), files[i].bytes, files[i].size, NULL));
        in = load(f, "a.pfm", IMAGE_AS_STORED);
        assert_float_equal(in.pixels[0], 1, 0);
        assert_float_equal(in.pixels[1], 2, 0);
        image_free(&in);
    }
}

static void test_budget_bounds_pictures(void **state) {
    Fixture *f = *state;
    Image image = make(3, NULL, false);
    save(f, &image, "b.png", IMAGE_SAMPLE_AUTO);
    save(f, &image, "b.ppm", IMAGE_SAMPLE_AUTO);
    size_t bytes = sample_count(&image) * sizeof(float);
    MemoryBudget budget = {.limit = bytes - 1};
    Image in;
    assert_false(image_load(&in, in_folder(f, "b.png"), IMAGE_AS_COLOUR, &budget, NULL));
    assert_false(image_load(&in, in_folder(f, "b.ppm"), IMAGE_AS_COLOUR, &budget, NULL));
    assert_int_equal(budget.used, 0);
    budget.limit = bytes;
    assert_true(image_load(&in, in_folder(f, "b.png"), IMAGE_AS_COLOUR, &budget, NULL));
    image_free(&in);
    assert_int_equal(budget.used, 0);
    image_free(&image);
}

static void assert_cannot(Fixture *f, const char *path, const char *word) {
    strbuf_clear(&f->error);
    assert_false(image_can_write(path, &f->error));
    assert_non_null(strstr(f->error.data, word));
    Image image = make(1, NULL, false);
    strbuf_clear(&f->error);
    assert_false(image_save(&image, path, IMAGE_SAMPLE_AUTO, &f->error));
    assert_non_null(strstr(f->error.data, word));
    image_free(&image);
}

static void test_impossible_targets_are_known_beforehand(void **state) {
    Fixture *f = *state;
    assert_cannot(f, in_folder(f, "x.gif89"), "unknown picture format '.gif89'");
    assert_cannot(f, in_folder(f, "png"), "no suffix");
    assert_cannot(f, in_folder(f, "a.png/x"), "no suffix");
    assert_cannot(f, in_folder(f, "no/such/x.png"), "no such folder");
    assert_true(mkdir(in_folder(f, "dir.png"), 0777) == 0);
    assert_cannot(f, in_folder(f, "dir.png"), "it is a folder");
    assert_true(image_can_write(in_folder(f, "ok.PNG"), NULL));
    assert_int_equal(access(f->path, F_OK), -1);
    assert_true(image_can_write("here.exr", NULL));
    rmdir(in_folder(f, "dir.png"));
    assert_int_equal(remove_all(f->folder), 0);
}

/* As somebody who may not: root may write anywhere. */
static void test_folders_without_permission(void **state) {
    Fixture *f = *state;
    uid_t self = geteuid();
    chmod(f->folder, 0555);
    if (self == 0) assert_int_equal(seteuid(65534), 0);
    assert_cannot(f, in_folder(f, "x.png"), "no permission");
    assert_cannot(f, in_folder(f, "x.ppm"), "no permission");
    assert_int_equal(seteuid(self), 0);
    chmod(f->folder, 0755);
}

/* The file's size is limited, so that writing fails half-way, as on a full disk. */
static void test_failed_write_leaves_nothing_new(void **state) {
    Fixture *f = *state;
    Image image = make(3, NULL, false);
    struct rlimit before, small;
    signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(ALL_SUFFIXES); i++) {
        char name[16];
        snprintf(name, sizeof name, "f.%s", ALL_SUFFIXES[i]);
        assert_true(whole_file_replace(in_folder(f, name), "old", 3, NULL));
        small = (struct rlimit){100, before.rlim_max};
        setrlimit(RLIMIT_FSIZE, &small);
        strbuf_clear(&f->error);
        bool done = image_save(&image, f->path, IMAGE_SAMPLE_AUTO, &f->error);
        setrlimit(RLIMIT_FSIZE, &before);
        assert_false(done);
        assert_non_null(strstr(f->error.data, "cannot write"));
        size_t size;
        unsigned char *bytes = whole_file_read(f->path, &size, NULL);
        assert_int_equal(size, 3);
        free(bytes);
        assert_int_equal(remove_all(f->folder), 1);
    }
    image_free(&image);
}

static void test_links_are_followed(void **state) {
    Fixture *f = *state;
    char link[160];
    snprintf(link, sizeof link, "%s/link.ppm", f->folder);
    assert_true(whole_file_replace(in_folder(f, "real.ppm"), "old", 3, NULL));
    assert_int_equal(symlink("real.ppm", link), 0);
    Image image = make(3, NULL, false);
    assert_true(image_save(&image, link, IMAGE_SAMPLE_AUTO, NULL));
    struct stat info;
    assert_true(lstat(link, &info) == 0 && S_ISLNK(info.st_mode));
    Image in = load(f, "real.ppm", IMAGE_AS_COLOUR);
    image_free(&in);
    image_free(&image);
}

static void test_missing_files_are_said_so(void **state) {
    Fixture *f = *state;
    Image image;
    assert_false(image_load(&image, in_folder(f, "none.png"), IMAGE_AS_COLOUR, NULL, &f->error));
    assert_non_null(strstr(f->error.data, "no such file"));
    strbuf_clear(&f->error);
    assert_false(image_load(&image, f->folder, IMAGE_AS_COLOUR, NULL, &f->error));
    assert_non_null(strstr(f->error.data, "folder"));
    assert_refused(f, "empty.png", "", 0);
    assert_refused(f, "text.png", "this is no picture", 18);
    assert_refused(f, "text.xyz", "this is no picture", 18);
}

int main(void) {
#define TEST(function) cmocka_unit_test_setup_teardown(function, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(test_float_formats_are_exact),
        TEST(test_half_exr_and_float_channels),
        TEST(test_integer_formats_hold_rounded_codes),
        TEST(test_alpha_survives),
        TEST(test_lossy_formats_are_near),
        TEST(test_equal_pictures_are_equal_files),
        TEST(test_metadata_come_back),
        TEST(test_lying_headers_are_refused),
        TEST(test_every_truncation_is_refused),
        TEST(test_damage_does_no_harm),
        TEST(test_pnm_reads_text_comments_and_both_endians),
        TEST(test_budget_bounds_pictures),
        TEST(test_impossible_targets_are_known_beforehand),
        TEST(test_folders_without_permission),
        TEST(test_failed_write_leaves_nothing_new),
        TEST(test_links_are_followed),
        TEST(test_missing_files_are_said_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
