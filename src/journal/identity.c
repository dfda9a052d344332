#include "journal/journal.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "deaspice/model.h"
#include "scene/keys.h"
#include "study/study.h"
#include "support/digest.h"
#include "support/number.h"
#include "support/memory_text.h"
#include "support/text.h"

#ifndef DEA_VERSION
#define DEA_VERSION "unknown"
#endif

enum { SHOWN = 48 };

/* With as many digits as tell the number from all others. */
static const char *exact_text(char text[DEA_NUMBER_LENGTH], double value)
{
    int digits = 15;
    do {
        snprintf(text, DEA_NUMBER_LENGTH, "%.*g", digits, value);
    } while (strtod(text, NULL) != value && ++digits < 18);
    return isnan(value) ? "none" : dea_number_text(text, value, digits);
}

static void put_number(FILE *out, const char *name, double value)
{
    char text[DEA_NUMBER_LENGTH];
    fprintf(out, "%s=%s\n", name, exact_text(text, value));
}

/* Many numbers: how many, the first, the last, and a digest of all. */
static void put_numbers(FILE *out, const char *name, const double *values, size_t count)
{
    char first[DEA_NUMBER_LENGTH] = "", last[DEA_NUMBER_LENGTH] = "";
    dea_digest digest = dea_digest_begin();
    dea_digest_take(&digest, values, count * sizeof *values);
    if (count > 0) {
        dea_number_text(first, values[0], 9);
        dea_number_text(last, values[count - 1], 9);
    }
    fprintf(out, "%s=%zu values %s ... %s (%016" PRIx64 ")\n", name, count, first, last, dea_digest_end(&digest));
}

/* Where scalars go, and whose they are. */
typedef struct scalars {
    FILE *out;
    const dea_scene *scene;
} scalars;

static void put_scalar(void *user, const dea_key *key)
{
    const scalars *to = user;
    put_number(to->out, key->path, dea_layout_number(to->scene, key->offset));
}

/* Constants are scalars too, but for those of a list. */
static void put_law(FILE *out, const char *of, const dea_law *law, const double *constants, size_t entries)
{
    char name[DEA_NAME_LENGTH];
    fprintf(out, "%s.law=%s\n", of, law ? law->name : "");
    if (law && law->entries > 1) {
        snprintf(name, sizeof name, "%s.constants", of);
        put_numbers(out, name, constants, entries * law->constant_count);
    }
}

static void put_lists(FILE *out, const dea_scene *scene)
{
    const dea_material *material = &scene->material;
    const dea_waveform *wave = &scene->drive.waveform;
    put_law(out, "material", material->law, material->constants, material->entry_count);
    put_law(out, "electrode", scene->electrode.law, scene->electrode.constants, scene->electrode.entry_count);
    const dea_antagonist *other = &scene->antagonist;
    if (other->there) {
        fprintf(out, "antagonist.kind=%d\nantagonist.material.law=%s\n", (int)other->kind, other->own_material ? other->material.law->name : "");
        put_numbers(out, "antagonist.material.constants", other->material.constants, other->own_material ? DEA_LAW_CONSTANTS : 0);
        put_number(out, "antagonist.material.permittivity", other->material.permittivity);
        put_number(out, "antagonist.material.permittivity.per_stretch", other->material.permittivity_per_stretch);
        put_number(out, "antagonist.material.modulus_slope.per_kelvin", other->material.modulus_slope);
        put_number(out, "antagonist.material.modulus_slope.reference", other->material.modulus_reference);
        put_number(out, "antagonist.material.density", other->material.density);
        put_number(out, "antagonist.material.modulus", other->material.modulus);
        put_number(out, "antagonist.material.breakdown", other->material.breakdown);
        put_numbers(out, "antagonist.material.prony", &other->material.prony[0].g, 2 * other->material.prony_count);
        fprintf(out, "antagonist.material.moduli=%s\nantagonist.material.permittivity.follows=%d\n",
                other->material.instantaneous ? "instantaneous" : "long-term", other->material.permittivity_follows ? 1 : 0);
    }
    for (size_t i = dea_load_count(); i < DEA_LOADS && scene->loads[i].kind; i++) { /* those without a key */
        put_number(out, scene->loads[i].kind->name, scene->loads[i].number);
    }
    put_numbers(out, "material.prony", &material->prony[0].g, 2 * material->prony_count);
    put_numbers(out, "material.shift", material->shift.table[0], 2 * material->shift.count);
    put_numbers(out, "material.stretches", material->stretches, 2);
    fprintf(out, "material.moduli=%s\n", material->instantaneous ? "instantaneous" : "long-term");
    if (material->permittivity_follows) {
        fputs("material.permittivity.follows=strain\n", out);
    }
    fprintf(out, "drive.waveform.kind=%d\n", (int)wave->kind);
    fprintf(out, "drive.waveform.choice=%zu\n", wave->choice);
    put_numbers(out, "drive.waveform.sines", &wave->sines[0].offset, wave->sine_count * sizeof wave->sines[0] / sizeof(double));
    put_numbers(out, "drive.waveform.times", wave->times, wave->point_count);
    put_numbers(out, "drive.waveform.voltages", wave->voltages, wave->point_count);
    if (dea_study_of(scene)->identify) {
        dea_study_of(scene)->identify(out, scene);
    }
    fprintf(out, "full=%d\n", scene->full ? 1 : 0);
}

static void put_study(FILE *out, const dea_scene *scene)
{
    fprintf(out, "study=%s\nmodel=", dea_study_of(scene)->name);
    for (size_t i = 0; i < scene->model_count; i++) {
        fprintf(out, "%s%s", i > 0 ? "," : "", scene->models[i]->name);
    }
    fprintf(out, "\nactuator.kind=%s\naxes=", scene->actuator.kind == DEA_DOT ? "dot" : "lens");
    for (size_t i = 0; i < scene->axis_count; i++) {
        fprintf(out, "%s%s", i > 0 ? "," : "", scene->axes[i].key);
    }
    fputs("\ncolumns=", out);
    const dea_layout layout = dea_layout_of(scene);
    for (size_t i = 0; i < layout.column_count; i++) {
        fprintf(out, "%s%s", i > 0 ? "," : "", layout.columns[i].name);
    }
    fputc('\n', out);
    for (size_t i = 0; i < scene->axis_count; i++) {
        char name[DEA_NAME_LENGTH + 16];
        snprintf(name, sizeof name, "axis %s", scene->axes[i].key);
        put_numbers(out, name, scene->axes[i].values, scene->axes[i].count);
    }
}

static bool same_crew(const dea_crew *a, const dea_crew *b)
{
    return a->count == b->count && memcmp(a->engines, b->engines, a->count * sizeof *a->engines) == 0;
}

/* All who may be asked, model by model where they are not the same: what comes out depends on each. */
static void put_engines(FILE *out, const dea_scene *scene, const dea_engine *engine)
{
    bool asked[DEA_ENGINES] = {false};
    dea_crew before = {0};
    fputs("engine=", out);
    for (size_t m = 0; m < scene->model_count; m++) {
        const dea_crew crew = dea_crew_of(scene, engine, scene->models[m]);
        const bool told = same_crew(&crew, &before);
        for (size_t i = 0; i < crew.count && !told; i++) {
            fprintf(out, "%s%s", i > 0 ? "," : m > 0 ? "; " : "", crew.engines[i]->name);
            for (size_t k = 0; dea_engine_at(k); k++) {
                asked[k] = asked[k] || dea_engine_at(k) == crew.engines[i];
            }
        }
        before = crew;
    }
    fputs("\nlibrary of the engine=", out);
    for (size_t k = 0; dea_engine_at(k); k++) {
        char library[DEA_NAME_LENGTH] = "none";
        if (asked[k] && dea_engine_at(k)->library) {
            dea_engine_at(k)->library(library, sizeof library);
        }
        fprintf(out, "%s%s", asked[k] ? library : "", asked[k] ? " " : "");
    }
    fputc('\n', out);
}

dea_status dea_identity_write(const dea_scene *scene, const dea_engine *engine, char **text, dea_error *error)
{
    dea_memory_text memory;
    dea_status status = dea_memory_text_begin(&memory, error);
    FILE *out = memory.out;
    if (status == DEA_OK) {
        fprintf(out, "program version=%s\n", DEA_VERSION);
        put_engines(out, scene, engine);
        put_study(out, scene);
        dea_keys_visit(scene, dea_key_is_scalar, put_scalar, &(scalars){out, scene});
        put_lists(out, scene);
    }
    status = dea_memory_text_end(&memory, status, error);
    *text = memory.text;
    return status;
}

/* Value of a line, fit for a message: the text is a stranger's. */
static const char *value_of(const char *line, char out[DEA_TEXT_ROOM])
{
    char value[2 * SHOWN] = "";
    const size_t name = strcspn(line, "=\n");
    if (line[name] == '=') {
        snprintf(value, sizeof value, "%.*s", (int)strcspn(line + name + 1, "\n"), line + name + 1);
    }
    return dea_text_clip(value, SHOWN, out, DEA_TEXT_ROOM);
}

void dea_identity_compare(const char *there, const char *here, char difference[DEA_IDENTITY_DIFFERENCE])
{
    char one[DEA_TEXT_ROOM], other[DEA_TEXT_ROOM];
    while (*there && *here) {
        const size_t length = strcspn(here, "\n");
        if (strcspn(there, "\n") != length || strncmp(there, here, length) != 0) {
            break;
        }
        here += length + (here[length] != '\0');
        there += length + (there[length] != '\0');
    }
    const size_t name = strcspn(here, "=\n");
    if (strncmp(there, here, name + 1) != 0) { /* a line that the other does not have */
        snprintf(difference, DEA_IDENTITY_DIFFERENCE, "other settings there");
        return;
    }
    snprintf(difference, DEA_IDENTITY_DIFFERENCE, "%.*s is %.90s there and %.90s here", (int)name, here, value_of(there, one),
             value_of(here, other));
}
