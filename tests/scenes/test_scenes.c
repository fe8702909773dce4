/* test_scenes FOLDER [PREFIX]: draws each scene FOLDER/PREFIX*.pov and compares it with POV-Ray's picture, FOLDER/NAME.png.
 *
 * They agree when the RMSE in linear light, over the pixels that are no edges, is below BOUND. A pixel is an edge when one of its
 * channels differs by more than STEP from that of one of its eight neighbours in POV-Ray's picture: there a hundredth of a pixel
 * matters. A scene needs pixels that are no edges: at least a third of all.
 * FOLDER/pending.txt names the scenes that are known to differ, one a line, with the reason; one that agrees must leave the list. */
#include "image/image.h"
#include "vts.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double BOUND = 0.01, STEP = 0.1;

typedef struct Verdict {
    double rmse, inner; /* over all pixels, and without edges */
    double edges;       /* share of the pixels */
    bool agrees;
    char trouble[400]; /* "" or why there is no comparison */
} Verdict;

static double channel(const Image *image, int x, int y, int c) {
    double value = (double)image_pixel(image, x, y)[image->channels >= 3 ? c : 0];
    return value >= 0 ? fmin(value, 1) : 0;
}

static bool differ(const Image *image, int x, int y, int x1, int y1) {
    if (x1 < 0 || y1 < 0 || x1 >= image->width || y1 >= image->height) return false;
    for (int c = 0; c < 3; c++)
        if (fabs(channel(image, x, y, c) - channel(image, x1, y1, c)) > STEP) return true;
    return false;
}

static bool is_edge(const Image *image, int x, int y) {
    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++)
            if (differ(image, x, y, x + dx, y + dy)) return true;
    return false;
}

static void compare(const Image *theirs, const Image *ours, Verdict *v) {
    if (theirs->width != ours->width || theirs->height != ours->height) {
        snprintf(v->trouble, sizeof v->trouble, "sizes differ");
        return;
    }
    double all = 0, inner = 0;
    int count = theirs->width * theirs->height, edges = 0;
    for (int y = 0; y < theirs->height; y++)
        for (int x = 0; x < theirs->width; x++) {
            double error = 0;
            for (int c = 0; c < 3; c++) error += pow(channel(theirs, x, y, c) - channel(ours, x, y, c), 2) / 3;
            bool edge = is_edge(theirs, x, y);
            all += error, inner += edge ? 0 : error, edges += edge;
        }
    v->rmse = sqrt(all / count), v->inner = sqrt(inner / fmax(count - edges, 1)), v->edges = (double)edges / count;
    v->agrees = v->inner < BOUND && v->edges < 2.0 / 3;
}

static bool draw(const char *scene, const char *picture, int width, int height, Verdict *v) {
    VtsOptions options = vts_options_default();
    options.width = width, options.height = height, options.threads = 2, options.stdlib_dir = VTS_SOURCE_DIR "/stdlib";
    VtsSession *session = vts_session_create(&options, NULL);
    bool drawn = session && vts_render(session, scene, picture) == VTS_OK;
    if (!drawn) snprintf(v->trouble, sizeof v->trouble, "%s", session ? vts_diagnostics(session) : "no session");
    vts_session_destroy(session);
    return drawn;
}

static Verdict judge(const char *folder, const char *name, const char *picture) {
    Verdict v = {0};
    char path[1024];
    StrBuf error = {0};
    Image theirs = {0}, ours = {0};
    snprintf(path, sizeof path, "%s/%s.png", folder, name);
    if (!image_load(&theirs, path, IMAGE_AS_COLOUR, NULL, &error)) {
        snprintf(v.trouble, sizeof v.trouble, "no picture of POV-Ray");
    } else {
        snprintf(path, sizeof path, "%s/%s.pov", folder, name);
        if (draw(path, picture, theirs.width, theirs.height, &v)) {
            if (image_load(&ours, picture, IMAGE_AS_COLOUR, NULL, &error)) compare(&theirs, &ours, &v);
            else snprintf(v.trouble, sizeof v.trouble, "the picture cannot be read");
        }
    }
    image_free(&theirs);
    image_free(&ours);
    strbuf_free(&error);
    return v;
}

/* Whether a line of pending.txt begins with the name. */
static bool is_pending(const char *folder, const char *name) {
    char line[1024];
    snprintf(line, sizeof line, "%s/pending.txt", folder);
    FILE *list = fopen(line, "r");
    bool found = false;
    while (list && !found && fgets(line, sizeof line, list)) found = strcspn(line, " :\n") == strlen(name) && !strncmp(line, name, strlen(name));
    if (list) fclose(list);
    return found;
}

/* 1 when the test fails by this scene. */
static int report(const char *name, const Verdict *v, bool pending) {
    const char *word = v->agrees ? pending ? "AGREES: take it off pending.txt" : "agrees" : pending ? "pending" : "DIFFERS";
    if (v->trouble[0]) printf("%-32s %s: %s\n", name, word, v->trouble);
    else printf("%-32s %.4f without edges, %.4f in all, %2.0f %% edges: %s\n", name, v->inner, v->rmse, 100 * v->edges, word);
    return v->agrees == pending;
}

static int compare_names(const void *a, const void *b) { return strcmp(*(char *const *)a, *(char *const *)b); }

/* The names, without ".pov", in order; the caller's, and the array too. */
static size_t scenes_in(const char *folder, const char *prefix, char ***out) {
    size_t count = 0, room = 0;
    char **names = NULL;
    DIR *stream = opendir(folder);
    for (struct dirent *entry; stream && (entry = readdir(stream));) {
        size_t length = strlen(entry->d_name);
        if (length < 5 || strcmp(entry->d_name + length - 4, ".pov") || strncmp(entry->d_name, prefix, strlen(prefix))) continue;
        if (count == room) names = realloc(names, (room = 2 * room + 16) * sizeof *names);
        names[count] = strdup(entry->d_name);
        names[count++][length - 4] = 0;
    }
    if (stream) closedir(stream);
    if (count) qsort(names, count, sizeof *names, compare_names);
    *out = names;
    return count;
}

int main(int argc, char **argv) {
    char scratch[] = "/tmp/vts-scenes-XXXXXX", picture[64];
    if (argc < 2 || !mkdtemp(scratch)) return 2;
    snprintf(picture, sizeof picture, "%s/picture.pfm", scratch);
    char **names;
    size_t count = scenes_in(argv[1], argc > 2 ? argv[2] : "", &names);
    int bad = count == 0;
    for (size_t i = 0; i < count; i++) {
        Verdict v = judge(argv[1], names[i], picture);
        bad += report(names[i], &v, is_pending(argv[1], names[i]));
        fflush(stdout);
        free(names[i]);
    }
    free(names);
    remove(picture);
    rmdir(scratch);
    return bad ? 1 : 0;
}
