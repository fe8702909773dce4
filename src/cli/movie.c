#include "cli/movie.h"

#include "cli/complaint.h"
#include "cli/frames.h"
#include "cli/interrupt.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

enum { MOST_ARGUMENTS = 40, COPY_SIZE = 1 << 16 };

/* How good ffmpeg's encoder of each container shall be; near to what the eye can tell. */
static const struct Container {
    const char *suffix, *quality[4];
} CONTAINERS[] = {
    {".mp4", {"-crf", "17", "-movflags", "+faststart"}},
    {".mov", {"-crf", "17", "-movflags", "+faststart"}},
    {".mkv", {"-crf", "17", NULL, NULL}},
    {".webm", {"-crf", "24", "-b:v", "0"}},
    {".gif", {NULL, NULL, NULL, NULL}},
};

static const struct Container *container_of(const char *path) {
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    for (size_t i = 0; dot && i < sizeof CONTAINERS / sizeof *CONTAINERS; i++)
        if (strcasecmp(dot, CONTAINERS[i].suffix) == 0) return &CONTAINERS[i];
    return NULL;
}

bool movie_is(const char *path) { return container_of(path) != NULL; }
static bool is_gif(const char *path) { return strcmp(container_of(path)->suffix, ".gif") == 0; }

/* ---- before ---- */

/* ffmpeg, in a folder of PATH. */
static bool find_ffmpeg(char path[PATH_MAX]) {
    const char *folders = getenv("PATH");
    for (size_t size; folders && *folders; folders += size + (folders[size] == ':')) {
        size = strcspn(folders, ":");
        int length = snprintf(path, PATH_MAX, "%.*s/ffmpeg", (int)(size < PATH_MAX ? size : 0), folders);
        struct stat info;
        if (size > 0 && length > 0 && length < PATH_MAX && stat(path, &info) == 0 && S_ISREG(info.st_mode) &&
            access(path, X_OK) == 0)
            return true;
    }
    return false;
}

static VtsStatus make_folder(const Settings *settings, const char *folder) {
    struct stat info;
    if ((mkdir(folder, 0777) == 0 || errno == EEXIST) && stat(folder, &info) == 0 && S_ISDIR(info.st_mode) &&
        access(folder, W_OK) == 0)
        return VTS_OK;
    complain(settings, "'%s', where the frames are to be kept, cannot be made: %s", folder,
             strerror(errno == EEXIST ? ENOTDIR : errno));
    return VTS_ERROR_FILE;
}

VtsStatus movie_begin(Movie *movie, Settings *settings, const char *path) {
    char text[PATH_MAX], program[PATH_MAX];
    if (!settings->animation.on)
        return (VtsStatus)complain_usage(
            settings,
            "'%s' is a film, and the scene has no animation { … } that says how many frames there are", path);
    if (settings->options.aovs)
        return (VtsStatus)complain_usage(settings, "--aov: '%s' cannot hold further channels: only .exr can",
                                         path);
    if (!is_gif(path) && !find_ffmpeg(program)) {
        complain(settings,
                 "'%s' is made by ffmpeg, which is not found: install it, or draw frames (-o frame.####.png) "
                 "or a .gif",
                 path);
        return VTS_ERROR_FILE;
    }
    int length = snprintf(text, sizeof text, "%s.frames", path);
    if (length < 0 || length + 24 > (int)sizeof text)
        return (VtsStatus)complain_usage(settings, "'%s' is too long", path);
    movie->path = path;
    movie->folder = settings_copy(settings, text, (size_t)length);
    length += snprintf(text + length, sizeof text - (size_t)length, "/########.png");
    movie->frames = settings_copy(settings, text, (size_t)length);
    return make_folder(settings, movie->folder);
}

/* ---- ffmpeg ---- */

/* Chroma has half the pixels each way: where their number is odd, the border is drawn once more. */
static void describe_filter(const VtsOptions *o, char *filter, size_t size) {
    int width = o->region[2] ? o->region[2] - o->region[0] : o->width,
        height = o->region[3] ? o->region[3] - o->region[1] : o->height;
    int right = width % 2, bottom = height % 2, length = 0;
    if (right || bottom)
        length = snprintf(filter, size, "pad=%d:%d,fillborders=right=%d:bottom=%d:mode=smear,", width + right,
                          height + bottom, right, bottom);
    snprintf(filter + length, size - (size_t)length,
             "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p");
}

static int start_ffmpeg(const Settings *settings, const char *output, int input, pid_t *child) {
    char program[PATH_MAX], filter[200], fps[40];
    if (!find_ffmpeg(program)) return ENOENT;
    describe_filter(&settings->options, filter, sizeof filter);
    snprintf(fps, sizeof fps, "%.9g", settings->animation.fps > 0 ? settings->animation.fps : 24);
    const char *arguments[MOST_ARGUMENTS] = {
        "ffmpeg",     "-hide_banner", "-loglevel",    "error",         "-y",    "-f",
        "image2pipe", "-c:v",         "png",          "-framerate",    fps,     "-i",
        "-",          "-vf",          filter,         "-colorspace",   "bt709", "-color_primaries",
        "bt709",      "-color_trc",   "iec61966-2-1", "-map_metadata", "-1",    "-fflags",
        "+bitexact",  "-flags:v",     "+bitexact"};
    int count = 0;
    while (arguments[count]) count++;
    for (int i = 0; i < 4 && container_of(output)->quality[i]; i++)
        arguments[count++] = container_of(output)->quality[i];
    char as_file[PATH_MAX + 8];
    snprintf(as_file, sizeof as_file, "file:%s", output); /* a name may hold a colon */
    arguments[count++] = as_file;
    posix_spawn_file_actions_t actions;
    int failed = posix_spawn_file_actions_init(&actions);
    if (failed) return failed;
    failed = posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    if (!failed) failed = posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    if (!failed)
        failed = posix_spawn(child, program, &actions, NULL, (char *const *)(void *)arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    return failed;
}

static bool write_all(int to, const char *bytes, size_t size) {
    while (size > 0) {
        ssize_t n = write(to, bytes, size);
        if (n < 0 && errno == EINTR && !interrupt_seen()) continue;
        if (n <= 0) return false;
        bytes += n;
        size -= (size_t)n;
    }
    return true;
}

static bool copy_file(const char *path, int to) {
    char bytes[COPY_SIZE];
    int from = open(path, O_RDONLY | O_CLOEXEC);
    bool good = from >= 0;
    for (ssize_t n = 1; good && n > 0;) {
        n = read(from, bytes, sizeof bytes);
        good = n >= 0 && write_all(to, bytes, (size_t)n);
    }
    if (from >= 0) close(from);
    return good;
}

typedef struct Frames {
    const char **paths;
    size_t count;
} Frames;

static Frames frames_of(const Movie *movie, Settings *settings) {
    Frames frames = {calloc((size_t)film_count(settings), sizeof(char *)), 0};
    FrameCursor cursor = {0};
    while (frames.paths && film_next(settings, &cursor)) {
        film_enter(settings, NULL, cursor.frame);
        frames.paths[frames.count++] = film_output(settings, movie->frames);
    }
    return frames;
}

/* An encoder that ends early is told by its status, not by a signal to us. */
static bool encode(const Settings *settings, const Frames *frames, const char *output) {
    int ends[2];
    pid_t child;
    if (pipe(ends) != 0) return false;
    for (int k = 0; k < 2; k++) fcntl(ends[k], F_SETFD, FD_CLOEXEC);
    struct sigaction ignore = {.sa_handler = SIG_IGN}, before;
    sigaction(SIGPIPE, &ignore, &before);
    int failed = start_ffmpeg(settings, output, ends[0], &child), status = -1;
    close(ends[0]);
    bool good = !failed;
    for (size_t i = 0; i < frames->count && good; i++)
        good = copy_file(frames->paths[i], ends[1]) && !interrupt_seen();
    close(ends[1]);
    if (!failed && !good) kill(child, SIGTERM);
    while (!failed && waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
    sigaction(SIGPIPE, &before, NULL);
    return good && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/* ---- after ---- */

/* Whether the folder's entry is a frame, or an unfinished one of a program that was killed. */
static bool is_ours(const char *name) {
    size_t digits = strspn(name, "0123456789");
    return digits > 0 && strncmp(name + digits, ".png", 4) == 0;
}

static void remove_folder(const Movie *movie) {
    DIR *folder = opendir(movie->folder);
    for (struct dirent *entry; folder && (entry = readdir(folder)) != NULL;)
        if (is_ours(entry->d_name)) unlinkat(dirfd(folder), entry->d_name, 0);
    if (folder) closedir(folder);
    rmdir(movie->folder);
}

static bool join(const Movie *movie, const Settings *settings, const Frames *frames) {
    char output[PATH_MAX], why[512] = "";
    double fps = settings->animation.fps > 0 ? settings->animation.fps : 24;
    int length =
        snprintf(output, sizeof output, "%s/film%s", movie->folder, container_of(movie->path)->suffix);
    if (length < 0 || length >= (int)sizeof output) return false;
    bool good = is_gif(movie->path)
                    ? vts_make_gif(frames->paths, frames->count, fps, output, why, sizeof why) == VTS_OK
                    : encode(settings, frames, output);
    if (*why) complain(settings, "%s", why);
    if (good && rename(output, movie->path) == 0) return true;
    if (good) complain(settings, "'%s' cannot be written: %s", movie->path, strerror(errno));
    unlink(output);
    return false;
}

VtsStatus movie_end(const Movie *movie, Settings *settings) {
    Frames frames = frames_of(movie, settings);
    bool good = frames.paths && join(movie, settings, &frames);
    free(frames.paths);
    if (good)
        remove_folder(movie);
    else if (interrupt_seen())
        return VTS_INTERRUPTED;
    else
        complain(settings, "'%s' is not made; its frames are in '%s', and --resume takes them", movie->path,
                 movie->folder);
    return good ? VTS_OK : VTS_ERROR_FILE;
}
