#include <stdlib.h>
#include <string.h>

#include "netlist/export.h"
#include "netlist/part.h"
#include "netlist/symbol.h"
#include "program/program.h"
#include "support/atomic.h"
#include "support/memory_text.h"

enum { PATH_ROOM = 4096 };

/* A kind of export. */
typedef struct kind {
    const char *name;
    const char *dialect; /* the only one, NULL: any */
    const char *ending;  /* of the symbol's file, which names a library of the same name and the ending .lib; NULL: one file */
    dea_status (*write)(dea_export *export, const char *library, dea_error *error);
} kind;

static dea_status write_netlist(dea_export *export, const char *library, dea_error *error)
{
    (void)library;
    return dea_export_netlist(export, error);
}

static dea_status write_part(dea_export *export, const char *library, dea_error *error)
{
    (void)library;
    dea_part_note(export->scene, export->note, sizeof export->note);
    return dea_part_of_scene(export->scene, export->scene->models[0], export->name, export->dialect, export->out, error);
}

static dea_status part_symbol(const dea_export *export, dea_symbol *symbol, dea_error *error)
{
    const dea_model *model = export->scene->models[0];
    return dea_symbol_of_part(export->scene, model, export->name, symbol)
               ? DEA_OK
               : dea_fail(error, DEA_ERROR_UNSUPPORTED, "the model %s is no part", model->name);
}

static dea_status write_kicad(dea_export *export, const char *library, dea_error *error)
{
    dea_symbol symbol;
    const char *prefix = export->name ? export->name : DEA_PART_PREFIX;
    const dea_symbol spring = dea_symbol_spring(prefix);
    const dea_symbol lever = dea_symbol_lever(prefix);
    const dea_status status = part_symbol(export, &symbol, error);
    if (status == DEA_OK) {
        dea_symbol_kicad_begin(export->out);
        dea_symbol_kicad(export->out, &symbol, library);
        dea_symbol_kicad(export->out, &spring, library);
        dea_symbol_kicad(export->out, &lever, library);
        dea_symbol_kicad_end(export->out);
    }
    return status;
}

static dea_status write_ltspice(dea_export *export, const char *library, dea_error *error)
{
    dea_symbol symbol;
    const dea_status status = part_symbol(export, &symbol, error);
    if (status == DEA_OK) {
        dea_symbol_ltspice(export->out, &symbol, library);
    }
    return status;
}

static const kind kinds[] = {
    {"netlist", NULL, NULL, write_netlist},
    {"subckt", NULL, NULL, write_part},
    {"kicad", "ngspice", ".kicad_sym", write_kicad},
    {"ltspice", "ltspice", ".asy", write_ltspice},
};

enum { KINDS = sizeof kinds / sizeof *kinds };

const char *dea_export_word(size_t index, char room[DEA_NAME_LENGTH])
{
    (void)room;
    return index < KINDS ? kinds[index].name : NULL;
}

/* A file in memory on its way to its target. */
typedef struct sheet {
    dea_atomic file;
    dea_memory_text memory;
} sheet;

/* Fills a sheet by @p write and puts it beside its target. */
static dea_status fill_sheet(sheet *s, dea_status (*write)(dea_export *, const char *, dea_error *), dea_export *export,
                             const char *path, const char *library, dea_error *error)
{
    dea_status status = dea_memory_text_begin(&s->memory, error);
    export->out = s->memory.out;
    status = status ? status : write(export, library, error);
    status = dea_memory_text_end(&s->memory, status, error);
    status = status ? status : dea_atomic_open(&s->file, path, error);
    return status == DEA_OK ? dea_atomic_write(&s->file, s->memory.text, s->memory.length, error) : status;
}

static dea_status close_sheet(sheet *s, dea_status status, dea_error *error)
{
    const dea_status closed =
        s->file.target ? dea_atomic_close(&s->file, status == DEA_OK, status == DEA_OK ? error : NULL) : DEA_OK;
    free(s->memory.text);
    return status == DEA_OK ? closed : status;
}

/* Path of the library beside a symbol. The symbol names it, so its name holds nothing that could end a string there. */
static dea_status library_path(const kind *as, const char *path, char library[PATH_ROOM], dea_error *error)
{
    const char *slash = path ? strrchr(path, '/') : NULL;
    const char *name = slash ? slash + 1 : path;
    const size_t length = path ? strlen(path) : 0;
    const size_t ending = strlen(as->ending);
    if (length <= ending || length >= PATH_ROOM - 8 || strcmp(path + length - ending, as->ending) != 0) {
        return dea_fail(error, DEA_ERROR_USAGE, "--as %s needs -o NAME%s; the library NAME.lib goes beside it", as->name,
                        as->ending);
    }
    if (name[strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-")] != '\0') {
        return dea_fail(error, DEA_ERROR_USAGE,
                        "the name of the file goes into the symbol: letters, digits, \".\", \"_\" and \"-\" "
                        "alone");
    }
    snprintf(library, PATH_ROOM, "%.*s.lib", (int)(length - ending), path);
    return DEA_OK;
}

/* A symbol and its library: both or none, unless the disk fails in between. */
static dea_status write_symbol(const kind *as, dea_export *export, const char *path, bool force, dea_error *error)
{
    char library[PATH_ROOM];
    sheet symbol = {.memory = {.text = NULL}};
    sheet part = {.memory = {.text = NULL}};
    dea_status status = library_path(as, path, library, error);
    status = status ? status : dea_files_target(export->scene->files, library, force, error);
    if (status != DEA_OK) {
        return status;
    }
    const char *slash = strrchr(library, '/');
    status = fill_sheet(&part, write_part, export, library, NULL, error);
    if (status == DEA_OK) {
        status = fill_sheet(&symbol, as->write, export, path, slash ? slash + 1 : library, error);
    }
    status = close_sheet(&part, status, error);
    return close_sheet(&symbol, status, error);
}

static dea_status write_one(const kind *as, dea_export *export, const char *path, dea_error *error)
{
    sheet s = {.memory = {.text = NULL}};
    const dea_status status = fill_sheet(&s, as->write, export, path ? path : "-", NULL, error);
    return close_sheet(&s, status, error);
}

static const kind *choose_kind(const char *name)
{
    size_t index;
    return dea_word_choose("kind of export", name, dea_export_word, &index) ? &kinds[index] : NULL;
}

static const dea_dialect *choose_dialect(const char *name)
{
    size_t index;
    return dea_word_choose("dialect", name, dea_dialect_word, &index) ? dea_dialect_at(index) : NULL;
}

static const dea_analogy *choose_analogy(const char *name)
{
    size_t index;
    return dea_word_choose("analogy", name, dea_analogy_word, &index) ? dea_analogy_at(index) : NULL;
}

/* Parts know one analogy and have a name, symbols know one dialect. */
static bool complain_mismatch(const dea_arguments *arguments, const kind *as)
{
    if (as->dialect && arguments->dialect && strcmp(as->dialect, arguments->dialect) != 0) {
        dea_complain("--as %s is of the dialect %s: leave out --dialect", as->name, as->dialect);
        return true;
    }
    if (as->write != write_netlist && arguments->analogy && dea_analogy_find(arguments->analogy)->loop) {
        dea_complain("a part has a mechanical pin of the mobility analogy: --analogy goes with --as netlist");
        return true;
    }
    if (as->write == write_netlist && arguments->name) {
        dea_complain("a netlist has no name: --name goes with --as subckt, kicad and ltspice");
        return true;
    }
    if (arguments->name && !dea_part_name_valid(arguments->name)) {
        dea_complain("the name \"%s\" is none for a part: a letter, then letters, digits and \"_\", at most %d", arguments->name,
                     DEA_PART_NAME_LENGTH);
        return true;
    }
    return false;
}

/* Name of a part: what the user gave, else that of the file that it goes to, else of the scene, so that the parts of several
 * scenes go into one circuit; NULL where both are standard streams: that of the library. */
static const char *choose_name(const dea_arguments *arguments, char own[DEA_PART_NAME_LENGTH + 1])
{
    const bool named = (arguments->output && dea_part_name_after(arguments->output, own)) ||
                       dea_part_name_after(arguments->operands[0].path, own);
    return arguments->name ? arguments->name : named ? own : NULL;
}

static bool is_one_model(const dea_scene *scene)
{
    if (scene->model_count > 1) {
        dea_complain("an export holds one model, the scene has %zu: choose one, --model %s", scene->model_count,
                     scene->models[0]->name);
    }
    return scene->model_count == 1;
}

static dea_exit write_scene(const dea_arguments *arguments, const kind *as, dea_export *export)
{
    dea_error error = {0};
    const dea_status status = as->ending ? write_symbol(as, export, arguments->output, arguments->force, &error)
                                         : write_one(as, export, arguments->output, &error);
    if (status != DEA_OK) {
        return dea_complain_error(&error);
    }
    if (export->note[0] && !arguments->quiet) {
        dea_complain("note: %s", export->note);
    }
    return DEA_EXIT_DONE;
}

static dea_exit run(const dea_arguments *arguments)
{
    dea_scene scene;
    char own[DEA_PART_NAME_LENGTH + 1];
    dea_exit outcome = DEA_EXIT_USAGE;
    if (!arguments->as) {
        dea_complain("export needs --as netlist, subckt, kicad or ltspice; see deaspice export --help");
        return DEA_EXIT_USAGE;
    }
    const kind *as = choose_kind(arguments->as);
    const char *dialect = arguments->dialect ? arguments->dialect : as && as->dialect ? as->dialect : "ngspice";
    dea_export export = {
        .scene = &scene,
        .dialect = as ? choose_dialect(dialect) : NULL,
        .analogy = as ? choose_analogy(arguments->analogy ? arguments->analogy : "mobility") : NULL,
        .analogy_given = arguments->analogy != NULL,
        .name = choose_name(arguments, own),
    };
    if (!as || !export.dialect || !export.analogy || complain_mismatch(arguments, as) ||
        !dea_scene_open(arguments, arguments->operands[0].path, &scene, &outcome)) {
        return outcome;
    }
    dea_model_choice choice;
    dea_signals_catch();
    if (dea_model_settle(&scene, dea_engine_find("ngspice"), arguments->quiet, &choice, &outcome) && is_one_model(&scene)) {
        outcome = write_scene(arguments, as, &export);
    }
    dea_scene_free(&scene);
    return outcome;
}

const dea_command dea_command_export = {
    .name = "export",
    .summary = "a scene as netlist, subcircuit or symbol for circuit simulators",
    .help = "Usage: deaspice export --as KIND [OPTION]... SCENE\n"
            "\n"
            "Writes a scene for another tool. SCENE is a YAML file, - is standard input.\n"
            "\n",
    .further = "The time step of a transient follows from the accuracy of the scene; a comment of\n"
               "the netlist tells where to change it.\n"
               "Exit status: 0 done, 1 the file was not written, 2 usage, a bad scene, or one that\n"
               "no netlist can hold.\n"
               "\n"
               "Examples:\n"
               "  deaspice export --as netlist dot.yaml -o dot.cir && ngspice -b -r dot.raw dot.cir\n"
               "  deaspice export --as netlist --dialect ltspice --analogy impedance dot.yaml -o dot.cir\n"
               "  deaspice export --as kicad dot.yaml -o dot.kicad_sym\n",
    .takes = DEA_TAKES_SCENE | DEA_TAKES_OUTPUT | DEA_TAKES_QUIET | DEA_TAKES_EXPORT,
    .least = 1,
    .most = 1,
    .files = ".yaml",
    .run = run,
};
