#define _GNU_SOURCE
#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "deaspice/fit.h"
#include "deaspice/model.h"
#include "netlist/export.h"
#include "program/options.h"
#include "scene/keys.h"
#include "support/quantity.h"
#include "support/text.h"

_Static_assert(DEA_RELAXATION_MOST == 10 && DEA_LAW_TERMS == 4, "the messages of --branches and --terms name them");

size_t dea_core_count(void)
{
    cpu_set_t set;
    int count = sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
    return count > 0 ? (size_t)count : 1;
}

static void *place_of(const dea_option *entry, dea_arguments *arguments)
{
    return (char *)arguments + entry->offset;
}

/* "--runs 0: needs a whole number ..."; @p why stands between, NULL: nothing does. */
static bool complain_value(const dea_option *entry, const char *value, const char *why)
{
    char shown[DEA_TEXT_ROOM];
    dea_text_clip(value, DEA_TEXT_SHOWN, shown, sizeof shown);
    dea_complain("--%s %s: %s%s %s", entry->name, shown, why ? why : "", why ? "; accepted:" : "needs", entry->needs);
    return false;
}

static bool take_flag(const dea_option *entry, const char *value, dea_arguments *arguments)
{
    (void)value;
    *(bool *)place_of(entry, arguments) = true;
    return true;
}

static bool take_text(const dea_option *entry, const char *value, dea_arguments *arguments)
{
    const char **place = place_of(entry, arguments);
    if (*place || *value == '\0') {
        dea_complain("--%s %s", entry->name, *place ? "is given twice" : "needs a value");
        return false;
    }
    *place = value;
    return true;
}

static bool take_setting(const dea_option *entry, const char *value, dea_arguments *arguments)
{
    (void)entry;
    arguments->settings[arguments->setting_count++].text = value;
    return true;
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

static bool take_size(const dea_option *entry, const char *value, dea_arguments *arguments)
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
        return complain_value(entry, value, NULL);
    }
    return true;
}

static bool take_log(const dea_option *entry, const char *value, dea_arguments *arguments)
{
    arguments->picture.log_x = strcmp(value, "x") == 0 || strcmp(value, "xy") == 0;
    arguments->picture.log_y = strcmp(value, "y") == 0 || strcmp(value, "xy") == 0;
    return arguments->picture.log_x || arguments->picture.log_y || complain_value(entry, value, NULL);
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

static bool take_count(const dea_option *entry, const char *value, dea_arguments *arguments)
{
    const long count = whole_number(value, (long)entry->high);
    if (count < 1) {
        return complain_value(entry, value, NULL);
    }
    *(size_t *)place_of(entry, arguments) = (size_t)count;
    return true;
}

static bool take_jobs(const dea_option *entry, const char *value, dea_arguments *arguments)
{
    if (strcmp(value, "auto") == 0 || strcmp(value, "0") == 0) {
        arguments->jobs = dea_core_count();
        return true;
    }
    return take_count(entry, value, arguments);
}

static bool in_range(const dea_option *entry, double value)
{
    return (entry->closed ? value >= entry->low : value > entry->low) && value < entry->high;
}

static bool take_number(const dea_option *entry, const char *value, dea_arguments *arguments)
{
    char reason[DEA_REASON_LENGTH] = "out of memory";
    double *place = place_of(entry, arguments);
    dea_units *units = dea_units_open();
    const bool read = units && dea_quantity_read(units, value, entry->unit, place, reason);
    dea_units_close(units);
    return read && in_range(entry, *place) ? true : complain_value(entry, value, read ? "out of range" : reason);
}

static bool take_shard(const dea_option *entry, const char *value, dea_arguments *arguments)
{
    char number[16];
    const size_t digits = strcspn(value, "/");
    snprintf(number, sizeof number, "%.*s", (int)digits, value);
    const long shards = value[digits] == '/' ? whole_number(value + digits + 1, (long)entry->high) : -1;
    const long shard = digits < sizeof number ? whole_number(number, shards) : -1;
    if (shard < 1) {
        return complain_value(entry, value, NULL);
    }
    if (arguments->shard > 0) {
        dea_complain("--%s is given twice", entry->name);
        return false;
    }
    arguments->shard = (size_t)shard;
    arguments->shards = (size_t)shards;
    return true;
}

static bool add_operand(dea_arguments *arguments, const char *path, dea_given_mode mode)
{
    arguments->operands[arguments->operand_count++] = (dea_operand){path, mode};
    return true;
}

static bool take_uniaxial(const dea_option *entry, const char *value, dea_arguments *arguments)
{
    (void)entry;
    return add_operand(arguments, value, DEA_GIVEN_UNIAXIAL);
}

static bool take_equibiaxial(const dea_option *entry, const char *value, dea_arguments *arguments)
{
    (void)entry;
    return add_operand(arguments, value, DEA_GIVEN_EQUIBIAXIAL);
}

/* Names of a table, and one word more. */
#define NAMES_OF(kind, more)                                                                                                     \
    const char *dea_##kind##_word(size_t index, char room[DEA_NAME_LENGTH])                                                      \
    {                                                                                                                            \
        (void)room;                                                                                                              \
        const dea_##kind *row = dea_##kind##_at(index);                                                                          \
        return row ? row->name : index == dea_##kind##_count() ? more : NULL;                                                   \
    }
NAMES_OF(engine, "auto")
NAMES_OF(law, "auto")
NAMES_OF(model, "auto")
NAMES_OF(dialect, NULL)
NAMES_OF(analogy, NULL)

/* Scalars of a scene by their paths. */
static const char *key_word(size_t index, char room[DEA_NAME_LENGTH])
{
    dea_key key;
    for (size_t i = 0; dea_key_at(i, &key); i++) {
        if (key.offset != DEA_KEY_NOWHERE && !strchr(key.path, '#') && index-- == 0) {
            return memcpy(room, key.path, DEA_NAME_LENGTH);
        }
    }
    return NULL;
}

/* Words of a list. */
#define WORDS_OF(kind, ...)                                                                                                      \
    static const char *kind##_word(size_t index, char room[DEA_NAME_LENGTH])                                                     \
    {                                                                                                                            \
        (void)room;                                                                                                              \
        static const char *const words[] = {__VA_ARGS__};                                                                        \
        return index < sizeof words / sizeof *words ? words[index] : NULL;                                                       \
    }
WORDS_OF(format, "csv", "nc", "raw")
WORDS_OF(axes, "x", "y", "xy")

#define FLAG(long_name, short_name, groups, member, help)                                                                        \
    {                                                                                                                            \
        .name = long_name, .letter = short_name, .group = groups, .take = take_flag, .offset = offsetof(dea_arguments, member),  \
        .about = help                                                                                                            \
    }
#define TEXT(long_name, short_name, shown, accepted, groups, reader, member, help)                                               \
    {                                                                                                                            \
        .name = long_name, .letter = short_name, .value = shown, .words = accepted, .group = groups, .take = reader,             \
        .offset = offsetof(dea_arguments, member), .about = help                                                                 \
    }
#define COUNT(long_name, short_name, shown, groups, reader, member, most, accepted, help)                                        \
    {                                                                                                                            \
        .name = long_name, .letter = short_name, .value = shown, .group = groups, .take = reader,                                \
        .offset = offsetof(dea_arguments, member), .high = most, .needs = accepted, .about = help                                \
    }
#define NUMBER(long_name, shown, groups, member, si, from, ends, to, accepted, help)                                             \
    {                                                                                                                            \
        .name = long_name, .value = shown, .group = groups, .take = take_number, .offset = offsetof(dea_arguments, member),      \
        .unit = si, .low = from, .closed = ends, .high = to, .needs = accepted, .about = help                                    \
    }

static const dea_option entries[] = {
    TEXT("engine", 0, "ENGINE", dea_engine_word, DEA_TAKES_ENGINE, take_text, engine,
         "engine that solves: auto, direct, ngspice, ida, or several with commas between, in the order in which they are asked"),
    TEXT("model", 0, "MODEL", dea_model_word, DEA_TAKES_SCENE, take_text, model,
         "model instead of the scene's; several with commas between; auto: the cheapest that is within the model error of the "
         "finest"),
    TEXT("set", 0, "KEY=VALUE", key_word, DEA_TAKES_SCENE, take_setting, settings,
         "change a value of the scene, e.g. actuator.prestretch=1.3; may be repeated"),
    FLAG("no-files", 0, DEA_TAKES_SCENE, no_files, "refuse a scene that names other files (material, waveform)"),
    TEXT("output", 'o', "FILE", NULL, DEA_TAKES_OUTPUT, take_text, output, "write the result to FILE, - is standard output"),
    TEXT("format", 0, "FORMAT", format_word, DEA_TAKES_FORMAT, take_text, format, "csv, nc or raw; default: from the ending of FILE"),
    TEXT("plot", 0, "FILE", NULL, DEA_TAKES_PLOT, take_text, plot,
         "draw the result, FILE ends in .svg, .png, .pdf, .eps or .gp (script and data)"),
    COUNT("size", 0, "WxH", DEA_TAKES_PLOT, take_size, picture, 0,
          "width x height in mm, cm, in or pt, each from 4 cm to 2 m, for example 8.5x6cm",
         "of the picture, e.g. 8.5x6cm (mm, cm, in, pt)"),
    {.name = "log",
     .value = "AXES",
     .words = axes_word,
     .group = DEA_TAKES_LOG,
     .take = take_log,
     .offset = offsetof(dea_arguments, picture),
     .needs = "x, y or xy",
     .about = "draw these axes logarithmic: x, y or xy"},
    FLAG("loops", 0, DEA_TAKES_LOG, picture.loops, "draw a transient over its voltage: hysteresis loops"),
    TEXT("columns", 0, "C[,C]", NULL, DEA_TAKES_LOG, take_text, picture.columns,
         "draw these columns of a sweep, e.g. capacitance_F,force_N"),
    FLAG("force", 0, DEA_TAKES_SCENE | DEA_TAKES_OUTPUT | DEA_TAKES_PLOT, force, "overwrite also a file that was read or that is there"),
    COUNT("jobs", 'j', "N", DEA_TAKES_JOBS, take_jobs, jobs, 1024, "a whole number up to 1024, or auto",
         "worker processes, auto: one per core"),
    FLAG("quiet", 'q', DEA_TAKES_QUIET, quiet, "no table, no notes, no summary and no progress"),
    FLAG("full", 0, DEA_TAKES_FULL, full, "a transient leaves out nothing, whatever its accuracy"),
    FLAG("no-truth", 0, DEA_TAKES_LOG, no_truth, "do not hold the models against the membrane (field)"),
    NUMBER("tolerance", "T", DEA_TAKES_TOLERANCE, tolerance, "1", 0, false, 1, "a number between 0 and 1, for example 1e-6",
         "difference that still agrees; default: the scene's accuracy, in a transient twice that, as both engines may be off by "
         "it"),
    TEXT("uniaxial", 0, "FILE", NULL, DEA_TAKES_FIT, take_uniaxial, operands, "data of a uniaxial test; may be repeated"),
    TEXT("equibiaxial", 0, "FILE", NULL, DEA_TAKES_FIT, take_equibiaxial, operands, "data of an equi-biaxial test; may be repeated"),
    TEXT("law", 0, "LAW", dea_law_word, DEA_TAKES_FIT, take_text, law,
         "yeoh (default), neo_hookean, mooney_rivlin, gent, ogden, arruda_boyce, or auto: the one with the least AICc"),
    COUNT("terms", 0, "N", DEA_TAKES_FIT, take_count, terms, DEA_LAW_TERMS, "1, 2, 3 or 4",
         "of Yeoh 1, 2 or 3 constants; default: as many as an F test finds significant at 5 %. Of Ogden 1 to 4 terms; default: "
         "as many as have the least AICc"),
    TEXT("relaxation", 0, "FILE", NULL, DEA_TAKES_FIT, take_text, tests[DEA_TEST_RELAXATION],
         "data of a relaxation test: time (since the end of the ramp, or with a displacement that shows the ramp) and stress or "
         "force"),
    TEXT("dma", 0, "FILE", NULL, DEA_TAKES_FIT, take_text, tests[DEA_TEST_DYNAMIC],
         "data of a dynamic test: frequency (Hz) or angular frequency (rad/s), storage modulus, and loss modulus or tan delta"),
    TEXT("creep", 0, "FILE", NULL, DEA_TAKES_FIT, take_text, tests[DEA_TEST_CREEP],
         "data of a creep test: time (since the end of the ramp) and strain, stretch, displacement or compliance, small enough "
         "to go with the stress; turned into branches of the modulus"),
    NUMBER("ramp", "TIME", DEA_TAKES_FIT, ramp, "s", 0, true, INFINITY,
           "a time, for example \"2 s\", or \"0 s\" for an ideal step",
         "duration of the ramp before the hold, e.g. \"2 s\"; default: what the displacement shows, else an ideal step"),
    NUMBER("length", "LENGTH", DEA_TAKES_FIT, specimen.length, "m", 0, false, INFINITY,
           "the length of the specimen at rest, for example \"80 mm\"",
         "length of the specimen at rest, for a displacement, e.g. \"80 mm\""),
    NUMBER("area", "AREA", DEA_TAKES_FIT, specimen.area, "m^2", 0, false, INFINITY,
           "the cross-section of the specimen at rest, for example \"22 mm^2\"",
         "its cross-section at rest, for a force, e.g. \"22 mm^2\""),
    COUNT("branches", 0, "N", DEA_TAKES_FIT, take_count, branches, DEA_RELAXATION_MOST, "a whole number from 1 to 10",
         "Prony branches, 1 to 10; default: as many as an F test finds significant at 5 %"),
    FLAG("relative", 0, DEA_TAKES_FIT, relative, "relative instead of absolute errors count"),
    NUMBER("permittivity", "NUMBER", DEA_TAKES_FIT, permittivity, "1", 0, false, INFINITY,
           "a relative permittivity above 0, for example 2.8",
         "relative permittivity of the film, written beside the fit, so that a scene can name the file as it is"),
    NUMBER("density", "DENSITY", DEA_TAKES_FIT, density, "kg/m^3", 0, false, INFINITY,
           "a density above 0, for example \"1080 kg/m^3\"",
         "density of the film, the same, e.g. \"1080 kg/m^3\""),
    NUMBER("breakdown", "FIELD", DEA_TAKES_FIT, breakdown, "V/m", 0, false, INFINITY, "a field above 0, for example \"80 V/um\"",
         "breakdown strength of the film, the same, e.g. \"80 V/um\""),
    TEXT("as", 0, "KIND", dea_export_word, DEA_TAKES_EXPORT, take_text, as,
         "netlist: the whole study, one model and one run, as a file that the simulator runs as it is (ngspice -b FILE); subckt: "
         "the actuator as a part with electrical pins p, n and a mechanical pin edge; kicad, ltspice: its symbol, -o "
         "NAME.kicad_sym or NAME.asy, and the library NAME.lib"),
    TEXT("dialect", 0, "DIALECT", dea_dialect_word, DEA_TAKES_EXPORT, take_text, dialect, "ngspice (default), ltspice, xyce or pspice"),
    TEXT("analogy", 0, "ANALOGY", dea_analogy_word, DEA_TAKES_EXPORT, take_text, analogy,
         "mobility (default): velocity is a voltage, force a current; impedance: force is a voltage, velocity a current"),
    TEXT("name", 0, "NAME", NULL, DEA_TAKES_EXPORT, take_text, name,
         "name of the part and of its helpers, NAME_spring and NAME_lever; else that of FILE, or of SCENE, without its ending: "
         "several parts in one circuit need different names"),
    COUNT("runs", 0, "N", DEA_TAKES_BENCH, take_count, runs, 1000, "a whole number from 1 to 1000",
         "timed runs of a setting, default 5; more where they are short, fewer where the budget ends"),
    NUMBER("budget", "SECONDS", DEA_TAKES_BENCH, budget, "1", 0, false, INFINITY, "a number of seconds above 0, for example 60",
         "time that all may take, roughly; default 60. What it does not reach is listed as skipped"),
    COUNT("shard", 0, "I/N", DEA_TAKES_JOURNAL, take_shard, shard, 1000000,
          "I/N with whole numbers 1 <= I <= N <= 1000000, for example 3/10",
         "solve only part I of N and write it to FILE, which deaspice merge joins with the others"),
    FLAG("resume", 0, DEA_TAKES_JOURNAL, resume,
         "go on where a run with --resume stopped, however it ended; what is solved is kept in FILE.journal until FILE is there"),
    NUMBER("to", "STRETCH", DEA_TAKES_CURVES, to, "1", 1, false, 100, "a stretch above 1 and below 100, for example 4",
         "largest stretch of table and curves, default 2"),
    {.name = "help", .letter = 'h', .about = "this text"},
    {.name = "version", .letter = 'V', .about = "the version"},
};

enum { ENTRIES = sizeof entries / sizeof entries[0], FIRST_CODE = 256 };

static bool takes(const dea_command *command, const dea_option *entry)
{
    return entry->group == 0 || (command->takes & entry->group) != 0;
}

const dea_option *dea_option_at(const dea_command *command, size_t index)
{
    for (int i = 0; i < ENTRIES; i++) {
        if (takes(command, &entries[i]) && index-- == 0) {
            return &entries[i];
        }
    }
    return NULL;
}

/* What an option is and, from a column on, what it does, its words broken before the last column. */
static void print_option(const dea_option *option)
{
    enum { COLUMN = 24, WIDTH = 80 };
    char letter[8] = "    ";
    if (option->letter) {
        snprintf(letter, sizeof letter, "-%c, ", option->letter);
    }
    int at = printf("  %s--%s%s%s", letter, option->name, option->value ? " " : "", option->value ? option->value : "");
    for (const char *word = option->about; *word;) {
        const int length = (int)strcspn(word, " ");
        if (at + 1 + length > WIDTH) {
            putchar('\n');
            at = 0;
        }
        at += printf("%*s%.*s", at < COLUMN ? COLUMN - at : 1, "", length, word);
        word += length + (word[length] == ' ');
    }
    putchar('\n');
}

void dea_help_print(const dea_command *command)
{
    fputs(command->help, stdout);
    for (size_t i = 0; dea_option_at(command, i); i++) {
        print_option(dea_option_at(command, i));
    }
    printf("%s%s", command->further ? "\n" : "", command->further ? command->further : "");
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
        const dea_option *entry = &entries[i];
        if (!takes(command, entry))
            continue;
        *longs++ = (struct option){entry->name, entry->value ? required_argument : no_argument, NULL, FIRST_CODE + i};
        if (entry->letter) {
            *letters++ = entry->letter;
            if (entry->value)
                *letters++ = ':';
        }
    }
    *longs = (struct option){0};
    *letters = '\0';
}

static const dea_option *entry_of(int code)
{
    for (int i = 0; i < ENTRIES; i++) {
        if (code == FIRST_CODE + i || (entries[i].letter && code == entries[i].letter))
            return &entries[i];
    }
    return NULL;
}

static dea_parsed take_option(const dea_command *command, int code, char **argv, dea_arguments *arguments)
{
    const dea_option *entry = entry_of(code);
    const char *word = argv[optind - 1];
    char letter[3] = {'-', (char)optopt, '\0'};
    if (code == ':') {
        const dea_option *lacking = entry_of(optopt);
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
    if (!entry->take)
        return entry->letter == 'h' ? DEA_PARSED_HELP : DEA_PARSED_VERSION;
    return entry->take(entry, optarg, arguments) ? DEA_PARSED_FINE : DEA_PARSED_WRONG;
}

static dea_parsed count_operands(const dea_command *command, const dea_arguments *arguments)
{
    if (arguments->operand_count < command->least)
        dea_complain("%s needs %s; see deaspice %s --help", command->name,
                     command->least > 1 ? "a scene and its parts"
                     : command->files   ? "a file"
                                        : "an operand",
                     command->name);
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
    *arguments = (dea_arguments){.tolerance = NAN};
    for (size_t i = 0; i < ENTRIES; i++) {
        if (entries[i].take == take_number)
            *(double *)place_of(&entries[i], arguments) = NAN;
    }
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
