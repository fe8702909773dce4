/* A film as one file: its frames are pictures in a folder beside it until all are drawn; then they are joined, and the folder goes. */
#ifndef VTS_CLI_MOVIE_H
#define VTS_CLI_MOVIE_H

#include "cli/settings.h"

typedef struct Movie {
    const char *path, *folder; /* of the file; of the frames */
    const char *frames;        /* a pattern with #### */
} Movie;

/* Whether the path's suffix is that of a film: .mp4, .mkv, .webm, .mov or .gif. */
bool movie_is(const char *path);
/* Before anything is drawn: says what is missing (a film in the scene, ffmpeg, the folder), and makes the folder. */
VtsStatus movie_begin(Movie *movie, Settings *settings, const char *path);
/* Joins the frames. When that fails they stay, and a message says where. */
VtsStatus movie_end(const Movie *movie, Settings *settings);

#endif
