/* Running gnuplot. */
#include "cli/chart.h"
#include "cli/complaint.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <spawn.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

const char *chart_terminal(const char *path) {
    static const char *const known[][2] = {
        {".svg", "svg size 900, 640 noenhanced font 'sans,12' background 'white'"},
        {".png", "pngcairo size 900, 640 noenhanced font 'sans,10' background 'white'"},
        {".pdf", "pdfcairo size 9, 6.4 noenhanced font 'sans,12' background 'white'"}};
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot && i < sizeof known / sizeof *known; i++)
        if (strcasecmp(dot, known[i][0]) == 0) return known[i][1];
    return NULL;
}

/* With the script as its input and the file as its output. The exit status; 127 when there is no such program. */
static int run_gnuplot(int script, int picture) {
    char *const arguments[] = {(char[]){"gnuplot"}, (char[]){"-d"}, (char[]){"-"}, NULL};
    posix_spawn_file_actions_t actions;
    pid_t child;
    if (posix_spawn_file_actions_init(&actions) != 0) return -1;
    posix_spawn_file_actions_adddup2(&actions, script, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, picture, STDOUT_FILENO);
    int error = posix_spawnp(&child, arguments[0], &actions, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error) return error == ENOENT ? 127 : -1;
    int status;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR) return -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static PlotStatus draw(FILE *script, const char *temporary) {
    int picture = open(temporary, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (picture < 0) return PLOT_FAILED;
    int status = run_gnuplot(fileno(script), picture);
    struct stat info;
    bool drawn = status == 0 && fstat(picture, &info) == 0 && info.st_size > 0;
    drawn = close(picture) == 0 && drawn;
    return drawn ? PLOT_DONE : status == 127 ? PLOT_NO_PROGRAM : PLOT_FAILED;
}

PlotStatus chart_plot(const Settings *settings, const char *script, const char *path) {
    char temporary[PATH_MAX];
    int length = snprintf(temporary, sizeof temporary, "%s.tmp-vts-%ld", path, (long)getpid());
    FILE *input = tmpfile();
    PlotStatus status = PLOT_FAILED;
    if (input && length > 0 && (size_t)length < sizeof temporary && fputs(script, input) >= 0 && fflush(input) == 0) {
        rewind(input);
        status = draw(input, temporary);
        if (status == PLOT_DONE && rename(temporary, path) != 0) status = PLOT_FAILED;
        if (status != PLOT_DONE) unlink(temporary);
    }
    if (input) fclose(input);
    if (status == PLOT_FAILED) complain(settings, "gnuplot could not draw '%s'", path);
    return status;
}
