/* Slurm: an array of jobs as a script, the job that joins its parts, and handing them over. */
#include "cli/complaint.h"
#include "cli/farm.h"
#include "cli/frames.h"
#include "cli/report_file.h"

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <spawn.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* Slurm takes numbers up to 1000 unless it is told otherwise (MaxArraySize). */
enum { MOST_TASKS = 1000 };

extern char **environ;

typedef struct Scripts {
    const Farm *farm;
    FILE *out;
    long long jobs, open; /* all, and those still to be done */
    long long run_first, run_last; /* of numbers that are still to be done: "3-7" */
    const char *between;
} Scripts;

/* ---- texts ---- */

/* "0-3,7,9-12" */
static void end_run(Scripts *w) {
    if (w->run_first < 0) return;
    fprintf(w->out, w->run_last > w->run_first ? "%s%lld-%lld" : "%s%lld", w->between, w->run_first, w->run_last);
    w->between = ",";
    w->run_first = -1;
}

static bool write_number(void *context, long long number, const FarmJob *job) {
    Scripts *w = context;
    w->jobs++;
    if (job->done) return true;
    w->open++;
    if (w->run_first >= 0 && number == w->run_last + 1) {
        w->run_last = number;
        return true;
    }
    end_run(w);
    w->run_first = w->run_last = number;
    return true;
}

static bool write_case(void *context, long long number, const FarmJob *job) {
    Scripts *w = context;
    fprintf(w->out, "%lld) exec ", number);
    farm_write_job(w->farm, job, "-t \"${SLURM_CPUS_ON_NODE:-0}\"", w->out);
    fputs(" ;;\n", w->out);
    return true;
}

/* A name that needs no quotes anywhere. */
static void write_job_name(const Farm *farm, const char *more, FILE *out) {
    const char *slash = strrchr(farm->scene, '/'), *name = slash ? slash + 1 : farm->scene;
    fputs("#SBATCH --job-name=vts-", out);
    for (; *name && *name != '.'; name++) fputc(isalnum((unsigned char)*name) || *name == '-' || *name == '_' ? *name : '_', out);
    fprintf(out, "%s\n", more);
}

static void write_head(const Farm *farm, const char *more, FILE *out) {
    fputs("#!/bin/bash\n", out);
    write_job_name(farm, more, out);
    for (size_t i = 0; i < farm->settings->sbatch.count; i++) fprintf(out, "#SBATCH %s\n", farm->settings->sbatch.items[i]);
}

static void write_folder(FILE *out) {
    char folder[PATH_MAX];
    if (!getcwd(folder, sizeof folder)) return;
    fputs("cd ", out);
    farm_write_word(folder, out);
    fputs(" || exit 3\n", out);
}

static void write_array(Scripts *w) {
    write_head(w->farm, "", w->out);
    if (w->farm->settings->options.threads) fprintf(w->out, "#SBATCH --cpus-per-task=%d\n", w->farm->settings->options.threads);
    fputs("#SBATCH --requeue\n#SBATCH --array=", w->out);
    w->between = "", w->run_first = -1;
    farm_each(w->farm, write_number, w);
    end_run(w);
    if (w->farm->settings->at_once) fprintf(w->out, "%%%d", w->farm->settings->at_once);
    fputs("\n\n", w->out);
    write_folder(w->out);
    fputs("case ${SLURM_ARRAY_TASK_ID:?\"is set for the tasks of an array: sbatch $0\"} in\n", w->out);
    farm_each(w->farm, write_case, w);
    fputs("esac\n", w->out);
}

/* A whole text into a file. */
static int keep(const Farm *farm, const char *path, char *text) {
    bool written = text && report_file_write(farm->settings, path, text);
    free(text);
    return written ? 0 : VTS_ERROR_FILE;
}

static int write_array_script(const Farm *farm, const char *path, Scripts *w) {
    char *text = NULL;
    size_t size;
    *w = (Scripts){.farm = farm, .out = open_memstream(&text, &size)};
    if (!w->out) return VTS_ERROR_MEMORY;
    write_array(w);
    fclose(w->out);
    if (w->open) return keep(farm, path, text);
    free(text);
    return 0;
}

static int write_stitch_script(const Farm *farm, const char *path) {
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    if (!out) return VTS_ERROR_MEMORY;
    write_head(farm, "-stitch", out);
    fputc('\n', out);
    write_folder(out);
    fputs("exec ", out);
    farm_write_stitch(farm, out);
    fputc('\n', out);
    fclose(out);
    return keep(farm, path, text);
}

/* ---- handing over ---- */

/* What a program prints on its standard output, up to a line's end. False when it cannot be run, with errno, or fails, with errno 0. */
static bool ask_program(char *const *arguments, char *answer, size_t size) {
    int ends[2], result = 0;
    pid_t child;
    posix_spawn_file_actions_t actions;
    if (pipe(ends) != 0) return false;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_addclose(&actions, ends[0]);
    posix_spawn_file_actions_addclose(&actions, ends[1]);
    int failed = posix_spawnp(&child, arguments[0], &actions, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    FILE *in = fdopen(ends[0], "r");
    if (!in) close(ends[0]);
    *answer = '\0';
    if (!failed && in && !fgets(answer, (int)size, in)) *answer = '\0';
    answer[strcspn(answer, "\r\n")] = '\0';
    if (in) fclose(in);
    while (!failed && waitpid(child, &result, 0) < 0 && errno == EINTR) continue;
    errno = failed;
    return !failed && WIFEXITED(result) && WEXITSTATUS(result) == 0 && *answer;
}

static void advise(const Farm *farm, const char *array, const char *stitch) {
    printf("submit with: sbatch ");
    farm_write_word(array, stdout);
    if (farm_is_cut(farm)) {
        fputs(", and when it is done: sbatch ", stdout);
        farm_write_word(stitch, stdout);
    }
    putchar('\n');
}

/* `after`: the job that comes before, or "". */
static int submit(const Farm *farm, const char *script, const char *after, char *job, size_t size) {
    char dependency[128];
    snprintf(dependency, sizeof dependency, "--dependency=afterok:%s", after);
    char program[] = "sbatch", parsable[] = "--parsable", files[] = "--", end[] = "--kill-on-invalid-dep=yes";
    char *const alone[] = {program, parsable, files, (char *)(uintptr_t)script, NULL};
    char *const later[] = {program, parsable, dependency, end, files, (char *)(uintptr_t)script, NULL};
    if (ask_program(*after ? later : alone, job, size)) {
        job[strcspn(job, ";")] = '\0'; /* "number;cluster" */
        return 0;
    }
    if (errno == 0) {
        complain(farm->settings, "sbatch did not take '%s'", script);
        return VTS_ERROR_FILE;
    }
    complain_warning(farm->settings, "sbatch cannot be run here (%s): nothing is submitted", strerror(errno));
    return -1;
}

static int submit_all(const Farm *farm, const char *array, const char *stitch, bool open) {
    char job[64] = "", last[64] = "";
    int status = open ? submit(farm, array, "", job, sizeof job) : 0;
    if (status == 0 && open) printf("submitted as job %s\n", job);
    if (status == 0 && farm_is_cut(farm)) status = submit(farm, stitch, job, last, sizeof last);
    if (status == 0 && farm_is_cut(farm)) printf("its parts will be joined by job %s\n", last);
    if (status < 0) advise(farm, array, stitch);
    return status < 0 ? 0 : status;
}

/* ---- all of it ---- */

static const char *script_name(Settings *settings, const char *scene) {
    if (settings->script) return settings->script;
    const char *output = settings->output, *suffix = settings->suffix;
    settings->output = NULL, settings->suffix = ".slurm";
    const char *name = settings_output_name(settings, scene);
    settings->output = output, settings->suffix = suffix;
    return name;
}

/* As many frames in a job as make an array that Slurm takes. */
static int fit_array(Farm *farm) {
    Settings *s = farm->settings;
    long long frames = s->animation.on ? film_count(s) : 1, most = MOST_TASKS / (farm->columns * farm->rows), least = (frames + most - 1) / most;
    if (s->chunk && s->chunk < least) return complain_usage(s, "--chunk: an array has %d tasks at most, which takes %lld frames in each", MOST_TASKS, least);
    if (least > 1000000) return complain_usage(s, "%lld frames are too many for one array: --frames for a part of them", frames);
    if (!s->chunk) farm->chunk = (int)least;
    return 0;
}

int farm_slurm(const Farm *given) {
    Farm farm = *given;
    Scripts written;
    char stitch[PATH_MAX + 16];
    const char *array = script_name(farm.settings, farm.scene);
    int length = snprintf(stitch, sizeof stitch, "%s.stitch", array), status = fit_array(&farm);
    if (length < 0 || (size_t)length >= sizeof stitch) return complain_usage(farm.settings, "the script's name is too long");
    if (status == 0) status = write_array_script(&farm, array, &written);
    if (status == 0 && farm_is_cut(&farm)) status = write_stitch_script(&farm, stitch);
    if (status != 0) return status;
    if (!written.open) printf("all %lld jobs are done\n", written.jobs);
    else printf("%s: %lld of %lld jobs\n", array, written.open, written.jobs);
    if (!written.open && !farm_is_cut(&farm)) return 0;
    if (!farm.settings->dry_run) return submit_all(&farm, array, stitch, written.open > 0);
    advise(&farm, array, stitch);
    return 0;
}
