/* vts farm: frames of a film and regions of pictures as jobs, each a command of its own. */
#ifndef VTS_CLI_FARM_H
#define VTS_CLI_FARM_H

#include "cli/settings.h"

#include <stdio.h>

enum { FARM_MOST_REGIONS = 1000 };

typedef struct Farm {
    Settings *settings;
    const char *program; /* path of the running vts */
    const char *scene;
    const char *output;  /* the whole; in a film with #### */
    const char *parts;   /* suffix of parts: that of the whole where the format keeps all of a picture, else ".exr" */
    bool lossless;       /* it does */
    int columns, rows;   /* 1 each: pictures are not cut */
    int chunk;           /* frames of a job */
} Farm;

/* One job: some frames, of all of which one region. */
typedef struct FarmJob {
    const char *frames; /* as --frames has them; NULL: there is no film */
    int region;         /* row by row; 0 where nothing is cut */
    bool done;          /* its pictures are there */
} FarmJob;

/* Calls `emit` for each job in turn, numbered from 0, up to its first false. False when that came. */
typedef bool FarmEmit(void *context, long long number, const FarmJob *job);
bool farm_each(const Farm *farm, FarmEmit *emit, void *context);

bool farm_is_cut(const Farm *farm);
/* The command of a job, and of what joins the parts, quoted for a shell, without a line's end. `threads` (or NULL) is put in as it is. */
void farm_write_job(const Farm *farm, const FarmJob *job, const char *threads, FILE *out);
void farm_write_stitch(const Farm *farm, FILE *out);
/* A word as a POSIX shell reads it. */
void farm_write_word(const char *word, FILE *out);

/* Writes the scripts of an array and of the job that joins its parts, and submits them. The exit status. */
int farm_slurm(const Farm *farm);

#endif
