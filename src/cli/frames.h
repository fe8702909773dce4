/* The frames of a film: which there are, which of them are to be done, and what their pictures are called. */
#ifndef VTS_CLI_FRAMES_H
#define VTS_CLI_FRAMES_H

#include "cli/settings.h"

/* Reads "1-10x2,15" into settings->animation; false when it is not that. */
bool film_parse_frames(Settings *settings, const char *text);

/* NULL, or what is wrong with POV-Ray's loop. */
const char *film_fault(const Settings *settings);

/* What a command does when nobody says which frames. */
typedef enum FilmUse { FILM_ALL, FILM_FIRST } FilmUse;

/* Joins what the scene's `animation` says with the command line, which has the last word. Not VTS_OK after a complaint. */
VtsStatus film_join(VtsSession *session, Settings *settings, const char *scene, FilmUse use);

/* Where one is in the frames; {0} is before the first. */
typedef struct FrameCursor {
    size_t range;
    long long next;
    bool begun;
    int frame; /* the one to do */
} FrameCursor;
/* The next frame to do; false after the last. Without a film there is one. */
bool film_next(const Settings *settings, FrameCursor *cursor);
/* How many film_next() gives. */
long long film_count(const Settings *settings);

/* Sets the options for a frame, and the session, which may be NULL. */
void film_enter(Settings *settings, VtsSession *session, int frame);
/* The session's options are those of the first frame that is to be done. film_join() with FILM_FIRST, and film_enter(). */
VtsStatus film_enter_first(VtsSession *session, Settings *settings, const char *scene);

/* `path` as the current frame's picture is called: with the frame's number in the place of the last #### of its name, else before its
 * suffix, as wide as the last frame's. Without a film it stays what it is. */
const char *film_output(Settings *settings, const char *path);

/* Whether a picture of this name is there: as pictures appear whole, it is finished. */
bool film_is_drawn(const char *path);

#endif
