/* make_terrain FOLDER [DEGREES]: a fractal country as SRTM would have it: DEGREES x DEGREES files of 3601 x 3601 posts, one arc second
 * apart, from 45 degrees north and 7 degrees east on. Three degrees are 10,801 x 10,801 posts. */
#include "base/random.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 3600, OCTAVES = 13, SOUTH = 45, WEST = 7, MOST_DEGREES = 9 };
static const double POST_METRES = 26, STEEPNESS = 0.2, ROUGHNESS = 0.85;

/* A row of values between lattice points 2^octave posts apart, smooth in both directions. */
static void add_octave(int octave, int row, int columns, float *heights) {
    const int step = 1 << octave, y = row / step;
    const double t = (double)(row % step) / step, weight = t * t * (3 - 2 * t);
    const double amplitude = STEEPNESS * POST_METRES * pow(step, ROUGHNESS);
    float before = 0, after = 0;
    for (int x = 0; x * step < columns; x++) {
        before = after;
        for (int k = x == 0 ? 0 : 1; k < 2; k++) {
            double low = random_unit(random_hash((uint64_t)x + (uint64_t)k, (uint64_t)y, (uint64_t)octave, 1));
            double high = random_unit(random_hash((uint64_t)x + (uint64_t)k, (uint64_t)y + 1, (uint64_t)octave, 1));
            double value = amplitude * (low + weight * (high - low) - 0.5);
            if (k == 0) before = (float)value;
            else after = (float)value;
        }
        for (int i = 0; i < step && x * step + i < columns; i++) {
            float s = (float)i / (float)step;
            heights[x * step + i] += before + (after - before) * s * s * (3 - 2 * s);
        }
    }
}

static int write_row(FILE **files, int degrees, const float *heights) {
    unsigned char bytes[2 * (SIDE + 1)];
    int written = 0;
    for (int k = 0; k < degrees; k++) {
        for (int i = 0; i <= SIDE; i++) {
            double height = 1500 + (double)heights[k * SIDE + i];
            int sample = (int)floor(fmin(fmax(height, -400), 8848) + 0.5);
            bytes[2 * i] = (unsigned char)(((unsigned)sample >> 8) & 255);
            bytes[2 * i + 1] = (unsigned char)((unsigned)sample & 255);
        }
        written += fwrite(bytes, sizeof bytes, 1, files[k]) == 1;
    }
    return written == degrees;
}

/* One row of files, from the north; the last row of posts is the first of the next files. */
static int write_files(const char *folder, int degrees, int from_north) {
    const int columns = degrees * SIDE + 1;
    FILE *files[MOST_DEGREES] = {NULL};
    float *heights = malloc((size_t)columns * sizeof *heights);
    int ok = heights != NULL;
    for (int k = 0; k < degrees && ok; k++) {
        char path[4096];
        snprintf(path, sizeof path, "%s/N%02dE%03d.hgt", folder, SOUTH + degrees - 1 - from_north, WEST + k);
        ok = (files[k] = fopen(path, "wb")) != NULL;
    }
    for (int r = 0; r <= SIDE && ok; r++) {
        for (int i = 0; i < columns; i++) heights[i] = 0;
        for (int octave = 0; octave < OCTAVES; octave++) add_octave(octave, from_north * SIDE + r, columns, heights);
        ok = write_row(files, degrees, heights);
    }
    for (int k = 0; k < degrees; k++)
        if (files[k]) ok &= fclose(files[k]) == 0;
    free(heights);
    return ok;
}

int main(int count, char **arguments) {
    int degrees = count > 2 ? atoi(arguments[2]) : 3;
    if (count < 2 || degrees < 1 || degrees > MOST_DEGREES) {
        fprintf(stderr, "make_terrain FOLDER [DEGREES, 1 to %d]\n", MOST_DEGREES);
        return 2;
    }
    for (int i = 0; i < degrees; i++)
        if (!write_files(arguments[1], degrees, i)) return 1;
    return 0;
}
