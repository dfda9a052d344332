#define _GNU_SOURCE
#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "deaspice/fit.h"
#include "program/program.h"
#include "scene/quantity.h"
#include "support/text.h"

enum { MOST_JOBS = 1024, MOST_SHARDS = 1000000, MOST_RUNS = 1000 };

/* An option of any command: what takes it, and what it does with its value; false when the value is wrong. */
typedef struct option_entry {
    const char *name;
    char letter; /* 0: none */
    bool valued;
    unsigned group; /* dea_takes; 0: every command */
    bool (*set)(dea_arguments *arguments, const char *value);
} option_entry;

size_t dea_core_count(void)
{
    cpu_set_t set;
    int count = sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
    return count > 0 ? (size_t)count : 1;
}

static bool set_text(const char **place, const char *name, const char *value)
{
    if (*place) {
        dea_complain("--%s is given twice", name);
        return false;
    }
    if (*value == '\0') {
        dea_complain("--%s needs a value", name);
        return false;
    }
    *place = value;
    return true;
}

static bool set_engine(dea_arguments *arguments, const char *value)
{
    return set_text(&arguments->engine, "engine", value) && dea_engine_choose(value) != NULL;
}

static bool set_model(dea_arguments *arguments, const char *value)
{
    return set_text(&arguments->model, "model", value);
}

static bool set_setting(dea_arguments *arguments, const char *value)
{
    arguments->settings[arguments->setting_count++].text = value;
    return true;
}

static bool set_output(dea_arguments *arguments, const char *value)
{
    return set_text(&arguments->output, "output", value);
}

static bool set_format(dea_arguments *arguments, const char *value)
{
    return set_text(&arguments->format, "format", value);
}

static bool set_plot(dea_arguments *arguments, const char *value)
{
    return set_text(&arguments->plot, "plot", value);
}

/* Metres of a unit of --size, NAN for a word that is none. */
static double size_unit(const char *name)
{
    static const struct {
        const char *name;
        double length; /* [m] */
    } units[] = {{"mm", 1e-3}, {"cm", 1e-2}, {"in", 0.0254}, {"pt", 0.0254 / 72.0}};
    for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
        if (strcmp(name, units[i].name) == 0) {
            return units[i].length;
        }
    }
    return NAN;
}

static bool set_size(dea_arguments *arguments, const char *value)
{
    dea_plot_options *picture = &arguments->picture;
    char first[3] = "", second[3] = "", more;
    bool read = sscanf(value, "%lf %2[a-z] x %lf %2[a-z] %c", &picture->width, first, &picture->height, second, &more) == 4;
    if (!read) { /* one unit for both */
        read = sscanf(value, "%lf x %lf %2[a-z] %c", &picture->width, &picture->height, second, &more) == 3;
        strcpy(first, second);
    }
    picture->width *= size_unit(first);
    picture->height *= size_unit(second);
    if (!read || !(picture->width >= DEA_PLOT_SIDE_LEAST && picture->width <= DEA_PLOT_SIDE_MOST) ||
        !(picture->height >= DEA_PLOT_SIDE_LEAST && picture->height <= DEA_PLOT_SIDE_MOST)) {
        dea_complain("--size %.40s: needs width x height in mm, cm, in or pt, each from 4 cm to 2 m, for example 8.5x6cm", value);
        return false;
    }
    return true;
}

static bool set_log(dea_arguments *arguments, const char *value)
{
    arguments->picture.log_x = strcmp(value, "x") == 0 || strcmp(value, "xy") == 0;
    arguments->picture.log_y = strcmp(value, "y") == 0 || strcmp(value, "xy") == 0;
    if (!arguments->picture.log_x && !arguments->picture.log_y) {
        dea_complain("--log %.40s: needs x, y or xy", value);
        return false;
    }
    return true;
}

/* Whole number of at most @p most, -1 where it is none. */
static long whole_number(const char *text, long most)
{
    char *end;
    errno = 0;
    long value = strtol(text, &end, 10);
    bool digits = *text >= '0' && *text <= '9';
    return digits && *end == '\0' && errno == 0 && value <= most ? value : -1;
}

static bool set_jobs(dea_arguments *arguments, const char *value)
{
    long jobs = strcmp(value, "auto") == 0 ? 0 : whole_number(value, MOST_JOBS);
    if (jobs < 0) {
        dea_complain("--jobs %s: needs a whole number up to %d, or auto", value, MOST_JOBS);
        return false;
    }
    arguments->jobs = jobs > 0 ? (size_t)jobs : dea_core_count();
    return true;
}

static bool set_quiet(dea_arguments *arguments, const char *value)
{
    (void)value;
    arguments->quiet = true;
    return true;
}

static bool set_full(dea_arguments *arguments, const char *value)
{
    (void)value;
    arguments->full = true;
    return true;
}

static bool set_force(dea_arguments *arguments, const char *value)
{
    (void)value;
    arguments->force = true;
    return true;
}

static bool set_no_files(dea_arguments *arguments, const char *value)
{
    (void)value;
    arguments->no_files = true;
    return true;
}

static bool set_tolerance(dea_arguments *arguments, const char *value)
{
    char *end;
    arguments->tolerance = strtod(value, &end);
    if (end == value || *end != '\0' || !(arguments->tolerance > 0 && arguments->tolerance < 1)) {
        dea_complain("--tolerance %s: needs a number between 0 and 1, for example 1e-6", value);
        return false;
    }
    return true;
}

static bool set_terms(dea_arguments *arguments, const char *value)
{
    long terms = whole_number(value, DEA_YEOH_TERMS);
    if (terms < 1) {
        dea_complain("--terms %s: needs 1, 2 or 3", value);
        return false;
    }
    arguments->terms = (unsigned)terms;
    return true;
}

static bool set_relative(dea_arguments *arguments, const char *value)
{
    (void)value;
    arguments->relative = true;
    return true;
}

static bool set_relaxation(dea_arguments *arguments, const char *value)
{
    return set_text(&arguments->relaxation, "relaxation", value);
}

static bool set_ramp(dea_arguments *arguments, const char *value)
{
    char reason[DEA_REASON_LENGTH] = "out of memory";
    dea_units *units = dea_units_open();
    const bool read = units && dea_quantity_read(units, value, "s", &arguments->ramp, reason);
    dea_units_close(units);
    if (!read || !(arguments->ramp >= 0.0)) {
        dea_complain("--ramp %s: %s; needs a time, for example \"2 s\", or \"0 s\" for an ideal step", value,
                     read ? "is negative" : reason);
        return false;
    }
    return true;
}

static bool set_branches(dea_arguments *arguments, const char *value)
{
    const long branches = whole_number(value, DEA_RELAXATION_MOST);
    if (branches < 1) {
        dea_complain("--branches %s: needs a whole number from 1 to %d", value, DEA_RELAXATION_MOST);
        return false;
    }
    arguments->branches = (size_t)branches;
    return true;
}

static bool set_as(dea_arguments *arguments, const char *value)
{
    return set_text(&arguments->as, "as", value);
}

static bool set_dialect(dea_arguments *arguments, const char *value)
{
    return set_text(&arguments->dialect, "dialect", value);
}

static bool set_analogy(dea_arguments *arguments, const char *value)
{
    return set_text(&arguments->analogy, "analogy", value);
}

static bool set_name(dea_arguments *arguments, const char *value)
{
    return set_text(&arguments->name, "name", value);
}

static bool set_runs(dea_arguments *arguments, const char *value)
{
    const long runs = whole_number(value, MOST_RUNS);
    if (runs < 1) {
        dea_complain("--runs %s: needs a whole number from 1 to %d", value, MOST_RUNS);
        return false;
    }
    arguments->runs = (size_t)runs;
    return true;
}

static bool set_budget(dea_arguments *arguments, const char *value)
{
    char *end;
    arguments->budget = strtod(value, &end);
    if (end == value || *end != '\0' || !(arguments->budget > 0.0 && arguments->budget < HUGE_VAL)) {
        dea_complain("--budget %s: needs a number of seconds above 0, for example 60", value);
        return false;
    }
    return true;
}

static bool set_shard(dea_arguments *arguments, const char *value)
{
    char number[16];
    const size_t digits = strcspn(value, "/");
    snprintf(number, sizeof number, "%.*s", (int)digits, value);
    const long shards = value[digits] == '/' ? whole_number(value + digits + 1, MOST_SHARDS) : -1;
    const long shard = digits < sizeof number ? whole_number(number, shards) : -1;
    if (shard < 1) {
        dea_complain("--shard %.40s: needs I/N with whole numbers 1 <= I <= N <= %d, for example 3/10", value, MOST_SHARDS);
        return false;
    }
    if (arguments->shard > 0) {
        dea_complain("--shard is given twice");
        return false;
    }
    arguments->shard = (size_t)shard;
    arguments->shards = (size_t)shards;
    return true;
}

static bool set_resume(dea_arguments *arguments, const char *value)
{
    (void)value;
    arguments->resume = true;
    return true;
}

static bool add_operand(dea_arguments *arguments, const char *path, dea_given_mode mode)
{
    arguments->operands[arguments->operand_count++] = (dea_operand){path, mode};
    return true;
}

static bool add_uniaxial(dea_arguments *arguments, const char *value)
{
    return add_operand(arguments, value, DEA_GIVEN_UNIAXIAL);
}

static bool add_equibiaxial(dea_arguments *arguments, const char *value)
{
    return add_operand(arguments, value, DEA_GIVEN_EQUIBIAXIAL);
}

static const option_entry entries[] = {
    {"engine", 0, true, DEA_TAKES_ENGINE, set_engine},
    {"model", 0, true, DEA_TAKES_SCENE, set_model},
    {"set", 0, true, DEA_TAKES_SCENE, set_setting},
    {"no-files", 0, false, DEA_TAKES_SCENE, set_no_files},
    {"output", 'o', true, DEA_TAKES_OUTPUT, set_output},
    {"format", 0, true, DEA_TAKES_FORMAT, set_format},
    {"plot", 0, true, DEA_TAKES_PLOT, set_plot},
    {"size", 0, true, DEA_TAKES_PLOT, set_size},
    {"log", 0, true, DEA_TAKES_LOG, set_log},
    {"force", 0, false, DEA_TAKES_SCENE | DEA_TAKES_OUTPUT | DEA_TAKES_PLOT, set_force},
    {"jobs", 'j', true, DEA_TAKES_JOBS, set_jobs},
    {"quiet", 'q', false, DEA_TAKES_QUIET, set_quiet},
    {"full", 0, false, DEA_TAKES_FULL, set_full},
    {"tolerance", 0, true, DEA_TAKES_TOLERANCE, set_tolerance},
    {"uniaxial", 0, true, DEA_TAKES_FIT, add_uniaxial},
    {"equibiaxial", 0, true, DEA_TAKES_FIT, add_equibiaxial},
    {"terms", 0, true, DEA_TAKES_FIT, set_terms},
    {"relaxation", 0, true, DEA_TAKES_FIT, set_relaxation},
    {"ramp", 0, true, DEA_TAKES_FIT, set_ramp},
    {"branches", 0, true, DEA_TAKES_FIT, set_branches},
    {"relative", 0, false, DEA_TAKES_FIT, set_relative},
    {"as", 0, true, DEA_TAKES_EXPORT, set_as},
    {"dialect", 0, true, DEA_TAKES_EXPORT, set_dialect},
    {"analogy", 0, true, DEA_TAKES_EXPORT, set_analogy},
    {"name", 0, true, DEA_TAKES_EXPORT, set_name},
    {"runs", 0, true, DEA_TAKES_BENCH, set_runs},
    {"budget", 0, true, DEA_TAKES_BENCH, set_budget},
    {"shard", 0, true, DEA_TAKES_JOURNAL, set_shard},
    {"resume", 0, false, DEA_TAKES_JOURNAL, set_resume},
    {"help", 'h', false, 0, NULL},
    {"version", 'V', false, 0, NULL},
};

enum { ENTRIES = sizeof entries / sizeof entries[0], FIRST_CODE = 256 };

static bool takes(const dea_command *command, const option_entry *entry)
{
    return entry->group == 0 || (command->takes & entry->group) != 0;
}

static void complain_option(const dea_command *command, const char *given)
{
    char dashed[ENTRIES][DEA_NAME_LENGTH];
    const char *names[ENTRIES];
    size_t count = 0;
    char word[DEA_NAME_LENGTH];
    char what[DEA_NAME_LENGTH];
    for (size_t i = 0; i < ENTRIES; i++) {
        if (!takes(command, &entries[i]))
            continue;
        snprintf(dashed[count], sizeof dashed[count], "--%s", entries[i].name);
        names[count] = dashed[count];
        count++;
    }
    snprintf(word, sizeof word, "%.*s", (int)strcspn(given, "="), given);
    snprintf(what, sizeof what, "option of %s", command->name);
    dea_complain_unknown(what, word, names, count);
}

/* Long options and letters that the command takes, in getopt's form; codes of long options are FIRST_CODE + entry. */
static void fill_getopt(const dea_command *command, struct option *longs, char *letters)
{
    *letters++ = ':';
    for (int i = 0; i < ENTRIES; i++) {
        const option_entry *entry = &entries[i];
        if (!takes(command, entry))
            continue;
        *longs++ = (struct option){entry->name, entry->valued ? required_argument : no_argument, NULL, FIRST_CODE + i};
        if (entry->letter) {
            *letters++ = entry->letter;
            if (entry->valued)
                *letters++ = ':';
        }
    }
    *longs = (struct option){0};
    *letters = '\0';
}

static const option_entry *entry_of(int code)
{
    for (int i = 0; i < ENTRIES; i++) {
        if (code == FIRST_CODE + i || (entries[i].letter && code == entries[i].letter))
            return &entries[i];
    }
    return NULL;
}

static dea_parsed take_option(const dea_command *command, int code, char **argv, dea_arguments *arguments)
{
    const option_entry *entry = entry_of(code);
    const char *word = argv[optind - 1];
    char letter[3] = {'-', (char)optopt, '\0'};
    if (code == ':') {
        const option_entry *lacking = entry_of(optopt);
        dea_complain("--%s needs a value", lacking ? lacking->name : letter);
        return DEA_PARSED_WRONG;
    }
    if (!entry && optopt >= FIRST_CODE) {
        dea_complain("--%s takes no value", entry_of(optopt)->name);
        return DEA_PARSED_WRONG;
    }
    if (!entry) {
        complain_option(command, optopt ? letter : word);
        return DEA_PARSED_WRONG;
    }
    if (!entry->set)
        return entry->letter == 'h' ? DEA_PARSED_HELP : DEA_PARSED_VERSION;
    return entry->set(arguments, optarg) ? DEA_PARSED_FINE : DEA_PARSED_WRONG;
}

static dea_parsed count_operands(const dea_command *command, const dea_arguments *arguments)
{
    if (arguments->operand_count < command->least)
        dea_complain("%s needs %s; see deaspice %s --help", command->name,
                     command->least > 1 ? "a scene and its parts" : "a file", command->name);
    else if (arguments->operand_count > command->most)
        dea_complain("%s takes one operand, \"%s\" is one too many", command->name, arguments->operands[command->most].path);
    else
        return DEA_PARSED_FINE;
    return DEA_PARSED_WRONG;
}

dea_parsed dea_arguments_parse(const dea_command *command, int argc, char **argv, dea_arguments *arguments)
{
    struct option longs[ENTRIES + 1];
    char letters[2 * ENTRIES + 2];
    *arguments = (dea_arguments){.tolerance = NAN, .ramp = NAN, .budget = NAN};
    arguments->settings = calloc((size_t)argc + 1, sizeof *arguments->settings);
    arguments->operands = calloc((size_t)argc + 1, sizeof *arguments->operands);
    if (!arguments->settings || !arguments->operands) {
        dea_complain("out of memory");
        return DEA_PARSED_WRONG;
    }
    fill_getopt(command, longs, letters);
    opterr = 0;
    dea_parsed parsed = DEA_PARSED_FINE;
    int code;
    while (parsed == DEA_PARSED_FINE && (code = getopt_long(argc, argv, letters, longs, NULL)) != -1)
        parsed = take_option(command, code, argv, arguments);
    for (; parsed == DEA_PARSED_FINE && optind < argc; optind++)
        add_operand(arguments, argv[optind], DEA_GIVEN_NONE);
    return parsed == DEA_PARSED_FINE ? count_operands(command, arguments) : parsed;
}

void dea_arguments_free(dea_arguments *arguments)
{
    free(arguments->settings);
    free(arguments->operands);
}
